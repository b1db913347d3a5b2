"""Forearms are moved out of what they are inside of, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.locomotion.clearing import clear_forearms, in_reach
from motionrt.locomotion.starting_poses import standing as shipped
from motionrt.metrics.penetration import THICKNESS, Surfaces
from motionrt.motion import SMPL24, Motion

FPS = 30.0
ARM = [SMPL24.index(f"left_{name}") for name in ("elbow", "wrist", "hand")]


def joint(motion: Motion, name: str) -> np.ndarray:
    return motion.positions()[:, SMPL24.index(name)].astype(np.float64)


@pytest.fixture(scope="module")
def stands() -> Motion:
    """Four seconds that move 2 m ahead: the arm passes what stands in the middle of the way."""
    pose = shipped()
    assert pose is not None
    root = np.repeat(pose.root, 120, axis=0)
    root[:, 2] += np.linspace(-1.0, 1.0, 120, dtype=np.float32)
    return Motion(np.repeat(pose.rotations, 120, axis=0), root, FPS)


def board(stands: Motion, off: float) -> np.ndarray:
    """An upright board along the way, beside the left wrist (outside is +x), 20 cm long, `off` m from its middle."""
    wrist = joint(stands, "left_wrist")[60]
    grid = np.meshgrid([wrist[0] + off], wrist[1] + np.arange(-0.3, 0.31, 0.02), np.arange(-0.1, 0.11, 0.02))
    return np.stack(grid, axis=-1).reshape(-1, 3)


def depth(motion: Motion, cloud: np.ndarray) -> np.ndarray:
    """(F,) metres that the left forearm is inside, from nothing but distances to points."""
    elbow, wrist = joint(motion, "left_elbow"), joint(motion, "left_wrist")
    along = elbow[:, None] + np.linspace(0.3, 1.0, 15)[:, None] * (wrist - elbow)[:, None]
    away = np.linalg.norm(along[:, :, None] - cloud, axis=-1).min(axis=(1, 2))
    return np.maximum(THICKNESS["forearm"] - away, 0.0)


@pytest.mark.parametrize("off", [0.01, 0.02])
def test_a_forearm_comes_out_of_a_board_that_it_passes(stands: Motion, off: float) -> None:
    cloud = board(stands, off)
    cleared = clear_forearms(stands, Surfaces(cloud), [])
    assert depth(stands, cloud).max() > 0.008
    assert depth(cleared, cloud).max() < 0.003


def test_only_the_arm_moves_only_meanwhile_and_without_a_jump(stands: Motion) -> None:
    cleared = clear_forearms(stands, Surfaces(board(stands, 0.01)), [])
    moved = np.linalg.norm(cleared.positions() - stands.positions(), axis=2)
    others = np.setdiff1d(np.arange(24), ARM)
    np.testing.assert_allclose(moved[:, others], 0.0, atol=1e-5)
    np.testing.assert_allclose(moved[[0, 20, 100, 119]], 0.0, atol=1e-5)
    assert moved.max() > 0.01
    assert np.abs(np.diff(moved, axis=0)).max() < 0.02  # metres a frame


def test_a_hand_that_holds_something_stays_there(stands: Motion) -> None:
    point = tuple(joint(stands, "left_hand")[60])
    cleared = clear_forearms(stands, Surfaces(board(stands, 0.01)), [(0, 120, {"left_hand": point})])
    np.testing.assert_allclose(cleared.positions(), stands.positions(), atol=1e-5)


def test_what_is_out_of_reach_changes_no_bit(stands: Motion) -> None:
    cleared = clear_forearms(stands, Surfaces(board(stands, 3.0)), [])
    np.testing.assert_array_equal(cleared.rotations, stands.rotations)
    np.testing.assert_array_equal(cleared.root, stands.root)


def test_only_what_an_arm_could_reach_is_looked_at_and_that_whole(stands: Motion) -> None:
    near, far = board(stands, 0.01), board(stands, 3.0)
    np.testing.assert_array_equal(in_reach(stands, np.concatenate([far, near])), near)
    assert in_reach(stands, far).shape == (0, 3)
