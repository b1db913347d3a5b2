"""The committed tiny models of generating are what their script writes."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")
pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")

from tiny_models import TINY_GENERATORS  # noqa: E402


def test_the_script_writes_the_committed_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TINY_GENERATORS.parent))
    importlib.import_module("make_tiny_generators").make(tmp_path)
    written = {path.relative_to(tmp_path): path for path in tmp_path.rglob("*.onnx")}
    committed = {path.relative_to(TINY_GENERATORS): path for path in TINY_GENERATORS.rglob("*.onnx")}
    assert set(written) == set(committed)
    for name, path in written.items():
        assert onnx.load(path) == onnx.load(committed[name])  # what they mean: protobuf may order bytes differently
