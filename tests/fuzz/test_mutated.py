"""A short run of the campaign (tests/fuzz/campaign.py has the long one), and the seeds it starts from."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest
from campaign import campaign
from doors import DOORS
from measured import measured, measured_all, warm
from motions import walking
from seeds import write_seeds

from motionrt.errors import FormatError
from motionrt.formats import load_motion

CASES = int(os.environ.get("MOTIONRT_FUZZ_CASES", "250"))


def test_mutated_files_are_read_or_refused_by_a_type_at_little_cost(tmp_path: Path) -> None:
    pytest.importorskip("trimesh", reason="meshes need the extra 'scene'")
    done = campaign(CASES, seed=7, found=tmp_path / "found")
    assert done.bad == []
    assert sum(done.counts.values()) == done.cases == CASES
    assert done.counts["loaded"] > CASES // 20  # they are not all torn to pieces
    assert CASES - done.counts["loaded"] > CASES // 5


def test_a_campaign_goes_on_where_it_was_left(tmp_path: Path) -> None:
    at_once = campaign(40, seed=8, found=tmp_path / "at_once")
    campaign(15, seed=8, found=tmp_path / "in_two")
    assert campaign(40, seed=8, found=tmp_path / "in_two") == at_once


def test_what_is_not_typed_or_ends_its_process_is_found_among_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    errors = {3: IndexError(), 7: FormatError("7", "refused"), 9: MemoryError()}

    def odd(path: Path) -> None:
        case = int(path.name)
        if case == 4:
            os.kill(os.getpid(), signal.SIGKILL)
        if case in errors:
            raise errors[case]

    monkeypatch.setitem(DOORS, "odd", odd)
    outcomes = dict(measured_all(range(12), lambda case: ("odd", tmp_path / str(case))))
    assert list(outcomes) == list(range(12))
    assert {case for case, outcome in outcomes.items() if not outcome.good} == {3, 4, 9}
    assert outcomes[3].error == "IndexError"
    assert outcomes[4].error == "signal 9"
    assert outcomes[7].error == "FormatError"


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
