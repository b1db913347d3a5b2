"""The committed tiny models are what their script writes."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")
pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")

from tiny_models import TINY  # noqa: E402


def test_the_script_writes_the_committed_files(tmp_path: Path) -> None:
    spec = importlib.util.spec_from_file_location("make_tiny_models", TINY.parent / "make_tiny_models.py")
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.make(tmp_path)
    written = {path.relative_to(tmp_path): path for path in tmp_path.rglob("*") if path.is_file()}
    committed = {path.relative_to(TINY): path for path in TINY.rglob("*") if path.is_file()}
    assert set(written) == set(committed)
    for name, path in written.items():
        if path.suffix == ".onnx":  # another protobuf may order bytes differently: compare what they mean
            assert onnx.load(path) == onnx.load(committed[name])
        elif path.suffix == ".json":
            assert path.read_bytes() == committed[name].read_bytes()
