"""Figures that were measured once: a file for people, and into the manifest every time."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from motionrt_export.measured import Measured

FIGURES = Measured(
    benchmark={"walknet": {"int8": {"p50_ms": 1.5, "call": "batch 1"}, "fp32": {"p50_ms": 3.0}}, "tmr_motion": {}},
    quality={"walknet": {"int8": {"foot skate (cm/frame)": 0.36}}},
    made={"benchmark": "two cores"},
)


def test_figures_go_round_in_the_order_of_the_manifest(tmp_path: Path) -> None:
    path = tmp_path / "figures.yaml"
    FIGURES.write(path)
    found = Measured.read(path)
    assert found == FIGURES
    assert list(found.benchmark) == ["tmr_motion", "walknet"]
    assert list(found.benchmark["walknet"]) == ["fp32", "int8"]
    assert found.of("quality", "walknet", "int8") == {"foot skate (cm/frame)": 0.36}
    assert found.of("benchmark", "transnet", "int8") == {}
    before = path.read_bytes()
    found.write(path)
    assert path.read_bytes() == before
    assert before.startswith(b"# Measured figures")


def test_without_a_file_there_are_none(tmp_path: Path) -> None:
    assert Measured.read(tmp_path / "figures.yaml") == Measured()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed: {}", "unknown section speed; there are made, benchmark and quality"),
        ("quality: {walknot: {int8: {a: 1}}}", "quality: there is no model 'walknot'"),
        ("benchmark: {pose_prior: {int8: {a: 1}}}", "benchmark: pose_prior has no variant 'int8'"),
        ("quality: {walknet: {int8: {a: [1]}}}", "walknet int8 holds something else than numbers and words"),
    ],
)
def test_what_belongs_nowhere_is_named(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "figures.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        Measured.read(path)
