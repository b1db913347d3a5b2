"""Checking files of ``new_joint_vecs``: files made by the reference pass, spoiled ones do not."""

from __future__ import annotations

from pathlib import Path

import guo_reference
import numpy as np
import pytest
from motions import random_motion, walking

from motionrt.errors import InvalidInputError
from motionrt.motion.features import guo_file


def published(frames: int = 30, turn: float = 0.4) -> np.ndarray:
    rows, _ = guo_reference.process(walking(frames, turn=turn).positions()[:, :22])
    return rows.astype(np.float32)


def test_a_file_of_the_published_formulas_agrees() -> None:
    found = guo_file.check(published())
    assert found.agrees
    assert found.recovered < 1e-6
    assert found.bone_lengths < 1e-6
    assert found.wrong_signs == ()


def test_a_file_whose_bones_are_others_agrees_and_says_so() -> None:
    rows, _ = guo_reference.process(random_motion(12, seed=2).positions()[:, :22])
    rows[:, [*range(1, 67), *range(193, 259)]] *= 1.1
    rows[:, 259:] = (np.square(rows[:, 193:259].reshape(-1, 22, 3)[:, [7, 10, 8, 11]]).sum(-1) < 0.002).astype(float)
    found = guo_file.check(rows.astype(np.float32))
    assert found.agrees
    assert found.bone_lengths == pytest.approx(0.1 * 0.43243298, rel=1e-3)


def test_the_wrong_sign_at_half_a_turn_is_found_and_mended() -> None:
    rows = published(70, turn=1.4)
    found = guo_file.check(rows)
    assert len(found.wrong_signs) == 1
    assert found.agrees


@pytest.mark.parametrize(
    ("column", "group"), [(3, "height"), (100, "rotations"), (200, "velocities"), (261, "contacts")]
)
def test_a_spoiled_column_is_named(column: int, group: str) -> None:
    rows = published()
    rows[5, column] += 0.1
    found = guo_file.check(rows)
    assert not found.agrees
    assert found.features[group] > 1e-3


def test_a_spoiled_yaw_step_moves_joints_away_from_where_the_velocities_lead() -> None:
    rows = published()
    rows[5, 0] += 0.05
    found = guo_file.check(rows)
    assert not found.agrees
    assert found.recovered > 1e-3


def test_files_that_hold_something_else_are_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "joints.npy", np.zeros((5, 22, 3)))
    np.save(tmp_path / "pickled.npy", np.array([{"motion": 1}]), allow_pickle=True)
    (tmp_path / "text.npy").write_text("no array")
    for path in [*tmp_path.iterdir(), tmp_path / "missing.npy"]:
        with pytest.raises(InvalidInputError, match=path.name):
            guo_file.load(path)
    with pytest.raises(InvalidInputError, match="two rows"):
        guo_file.check(np.zeros((1, 263)))
    np.save(tmp_path / "rows.npy", published())
    np.testing.assert_array_equal(guo_file.load(tmp_path / "rows.npy"), published())
