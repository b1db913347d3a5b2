"""A short run of the campaign (tests/fuzz/campaign.py has the long one), and the seeds it starts from."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from campaign import campaign
from measured import measured, warm
from motions import walking
from seeds import write_seeds

from motionrt.formats import load_motion

CASES = int(os.environ.get("MOTIONRT_FUZZ_CASES", "250"))


def test_mutated_files_are_read_or_refused_by_a_type_at_little_cost(tmp_path: Path) -> None:
    pytest.importorskip("trimesh", reason="meshes need the extra 'scene'")
    counts, bad = campaign(CASES, seed=7, found=tmp_path / "found")
    assert bad == []
    assert sum(counts.values()) == CASES
    assert counts["loaded"] > CASES // 20  # they are not all torn to pieces
    assert CASES - counts["loaded"] > CASES // 5


def test_the_seeds_are_sound(tmp_path: Path) -> None:
    pytest.importorskip("trimesh", reason="meshes need the extra 'scene'")
    warm()
    for name, (door, path) in write_seeds(tmp_path).items():
        assert measured(door, path).kind == "loaded", (name, measured(door, path))


@pytest.mark.parametrize(("suffix", "close"), [(".bvh", 2e-4), (".glb", 1e-4), (".npz", 1e-4)])
def test_the_seeds_load_to_the_motion_that_was_written(tmp_path: Path, suffix: str, close: float) -> None:
    clip = walking(12)
    loaded = load_motion(clip.save(tmp_path / f"clip{suffix}"))
    np.testing.assert_allclose(loaded.positions(), clip.positions(), atol=close)
