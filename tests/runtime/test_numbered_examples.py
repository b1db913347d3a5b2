"""Every numbered example runs as it stands, and leaves readable motions where it was told to."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import motionrt

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("[0-9][0-9]_*.py"))
QUIET = {"03_describe", "06_body_parts", "09_stream", "10_crowd", "16_picture"}  # they save no motion


def test_there_are_examples_and_their_numbers_go_on() -> None:
    assert [int(path.name[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))
    assert len(EXAMPLES) >= 12


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_saves_what_it_says(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    if path.stem == "16_picture":
        pytest.importorskip("PIL", reason='the picture needs Pillow: pip install "motionrt[render]"')
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.main(tmp_path)
    saved = [file for suffix in (".bvh", ".glb", ".npz") for file in tmp_path.glob(f"*{suffix}")]
    for file in saved:
        which = 0 if file.suffix == ".glb" else None  # the newest; a character's file keeps its own
        assert np.isfinite(motionrt.load_motion(file, animation=which).positions()).all()
    assert bool(saved) != (path.stem in QUIET) or path.stem == "02_own_library"
    assert saved or capsys.readouterr().out or list(tmp_path.iterdir())
