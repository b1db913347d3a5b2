"""Exported files: declared as agreed, the same bytes twice, nothing of this machine inside."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import tiny_sources  # noqa: E402

from motionrt_export.optimise import CHOICES, quantise  # noqa: E402
from motionrt_export.specs import OPSET  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402


@pytest.mark.parametrize("name", list(CHOICES))
def test_two_exports_are_the_same_bytes(tmp_path: Path, name: str) -> None:
    def export() -> tuple[bytes, bytes]:
        sources = tiny_sources(tmp_path)
        source = sources.source(name)
        exact = trace(source.module, source.spec)
        choice = CHOICES[name]
        small = quantise(exact, choice, source.calibration()) if choice else exact
        return exact.SerializeToString(deterministic=True), small.SerializeToString(deterministic=True)

    assert export() == export()


@pytest.mark.parametrize("name", list(CHOICES))
def test_a_file_is_valid_and_holds_nothing_of_this_machine(tmp_path: Path, name: str) -> None:
    source = tiny_sources(tmp_path).source(name)
    model = trace(source.module, source.spec)
    onnx.checker.check_model(model, full_check=True)
    assert [entry.version for entry in model.opset_import] == [OPSET]
    content = model.SerializeToString()
    for text in (b".py", str(Path.home()).encode(), b"site-packages"):
        assert text not in content


@pytest.mark.parametrize("name", list(CHOICES))
def test_no_shape_arithmetic_is_left_in_the_layers(tmp_path: Path, name: str) -> None:
    source = tiny_sources(tmp_path).source(name)
    graph = trace(source.module, source.spec).graph
    inner = [node.name for node in graph.node if node.op_type == "Shape" and "/layers" in node.name]
    assert inner == []
