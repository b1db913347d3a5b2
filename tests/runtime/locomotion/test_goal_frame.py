"""The goal-centric frame: the goal is the origin, and everything comes back exactly (eq. 2-5)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.locomotion.goal_frame import Goal, canonicalise, frames_from_goal, frames_to_goal, uncanonicalise
from motionrt.motion.features import ccf219

places = st.floats(-200, 200)
headings = st.floats(-7, 7)


@given(places, places, headings, st.integers(0, 5))
def test_frames_come_back_to_a_millionth_however_far_the_goal(x: float, z: float, heading: float, seed: int) -> None:
    frames = ccf219.encode(random_motion(4, seed=seed))[None].astype(np.float64)
    goals = np.array([[x, z, heading]])
    np.testing.assert_allclose(frames_from_goal(frames_to_goal(frames, goals), goals), frames, atol=1e-6)
    np.testing.assert_allclose(frames_to_goal(frames_from_goal(frames, goals), goals), frames, atol=1e-6)


@given(st.floats(-3, 3), st.floats(-3, 3), headings)
def test_motions_come_back_to_a_millionth(x: float, z: float, heading: float) -> None:
    motion, goal = random_motion(4), Goal(x, z, heading)
    back = uncanonicalise(canonicalise(motion, goal), goal)
    np.testing.assert_allclose(back.root, motion.root, atol=1.5e-6)  # two roundings of float32 metres
    np.testing.assert_allclose(back.rotations, motion.rotations, atol=1e-6)


def test_the_frame_is_what_scipy_turns_and_moves() -> None:
    motion, goal = random_motion(5, seed=3), Goal(2.0, -1.5, 0.8)
    seen = canonicalise(motion, goal)
    turn = Rotation.from_euler("y", -0.8)
    np.testing.assert_allclose(seen.root, turn.apply(motion.root - [2.0, 0, -1.5]), atol=1e-5)
    np.testing.assert_allclose(seen.rotations[:, 0], turn.as_matrix() @ motion.rotations[:, 0], atol=1e-6)
    np.testing.assert_array_equal(seen.rotations[:, 1:], motion.rotations[:, 1:])
    np.testing.assert_allclose(
        seen.positions(), turn.apply((motion.positions() - [2.0, 0, -1.5]).reshape(-1, 3)).reshape(5, 24, 3), atol=1e-5
    )


def test_a_body_at_its_goal_stands_at_the_origin_facing_z() -> None:
    goal = Goal(4.0, 7.0, np.pi / 2)
    ahead = uncanonicalise(canonicalise(random_motion(1), Goal(0, 0)), goal)
    seen = canonicalise(ahead, goal)
    np.testing.assert_allclose(seen.root, random_motion(1).root, atol=1e-5)
    # one metre along the goal's heading (+X) is one metre along +Z of its frame
    frames = ccf219.encode(ahead).astype(np.float64)[None]
    frames[..., 216] += 1.0
    moved = frames_to_goal(frames, np.array([goal.row()]))
    np.testing.assert_allclose(moved[0, 0, 216:] - seen.root[0], [0, 0, 1], atol=1e-5)


def test_heights_stay() -> None:
    motion = random_motion(6, seed=2)
    np.testing.assert_array_equal(canonicalise(motion, Goal(5, 5, 1)).root[:, 1], motion.root[:, 1])


def test_a_batch_has_a_goal_for_each() -> None:
    motions = [random_motion(3, seed=seed) for seed in range(3)]
    goals = [Goal(1, 2, 3), Goal(-4, 0, 0.1), Goal(0, 0, -2)]
    frames = frames_to_goal(np.stack([ccf219.encode(m) for m in motions]), np.array([goal.row() for goal in goals]))
    for row, motion, goal in zip(frames, motions, goals, strict=True):
        np.testing.assert_allclose(row, ccf219.encode(canonicalise(motion, goal)), atol=1e-5)


@pytest.mark.parametrize("row", [(np.nan, 0, 0), (0, np.inf, 0), (0, 0, np.nan)])
def test_a_goal_that_is_no_place_is_refused(row: tuple[float, float, float]) -> None:
    with pytest.raises(InvalidInputError, match="three finite numbers"):
        Goal(*row)
