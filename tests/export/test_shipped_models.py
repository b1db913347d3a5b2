"""The shipped files: complete, untouched, and from the checkpoints and with the promises that the manifest names."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from motionrt.models import load_manifest, verify
from motionrt_export.pipelines import PIPELINES
from motionrt_export.tolerances import pipeline_tolerance, tolerance
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


def test_the_wheel_takes_every_shipped_file() -> None:
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    files = [MANIFEST.models[model].variants[variant].file for model, variant in SHIPPED]
    missing = [file for file in files if f'"{file}" = "motionrt/_assets/{file}"' not in project]
    assert missing == [], "add them to [tool.hatch.build.targets.wheel.force-include]"


def test_the_released_checkpoint_is_the_one_that_the_manifest_names() -> None:
    _, notes = load_release(ROOT / "models" / "tmr.safetensors", TMR)
    assert notes["recipe"] == "tmr"
    assert int(notes["steps"]) == MANIFEST.models["tmr_text"].recipe["steps"]


def test_the_manifest_promises_what_files_are_validated_with() -> None:
    for model, variant in SHIPPED:
        promised = MANIFEST.models[model].variants[variant].tolerance
        expected = dict(tolerance(model, variant))
        for pipeline, drift in PIPELINES.items():
            if drift.owner == model and pipeline in promised:
                expected |= pipeline_tolerance(pipeline, variant)
        assert promised == expected
