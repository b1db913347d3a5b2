"""A command line whose models are instant, and a folder to index."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_embedder import FakeEmbedder
from motions import random_motion, walking

from motionrt.cli import main
from motionrt.services import search as search_module

Command = Callable[..., int]


@pytest.fixture(autouse=True)
def fake_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search_module, "TextMotionModel", lambda *_, **__: FakeEmbedder())


@pytest.fixture
def library(tmp_path: Path) -> Path:
    folder = tmp_path / "my motions"
    (folder / "ä").mkdir(parents=True)
    walking(60).save(folder / "walk.bvh")
    walking(60, turn=0.6).save(folder / "ä" / "kreis.bvh")
    random_motion(300).save(folder / "long.npz")
    return folder


@pytest.fixture
def gallery(library: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    assert main(["gallery", "build", str(library), "--jobs", "1"]) == 0
    capsys.readouterr()
    return library


@pytest.fixture
def run_json(capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """Run a command that must succeed, with ``--json``, and give what it printed."""

    def run(*arguments: object, code: int = 0) -> Any:
        assert main([*map(str, arguments), "--json"]) == code
        return json.loads(capsys.readouterr().out)

    return run
