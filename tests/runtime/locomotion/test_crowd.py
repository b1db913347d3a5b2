"""One frame at a time: towards the goal, all together as one by one, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels, towards_goal
from motions import random_motion, walking

from motionrt.errors import InvalidInputError, WalkError
from motionrt.locomotion.crowd import Crowd, history_of, to_motion
from motionrt.locomotion.crowd_start import ABREAST, crowd
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.starting_poses import stride_of

STRIDE = stride_of(walking(40, FPS))


def histories(*starts: tuple[float, float, float]) -> np.ndarray:
    return np.stack([history_of(uncanonicalise(STRIDE, Goal(*start))) for start in starts])


def test_a_step_goes_a_thirtieth_of_a_second_towards_the_goal() -> None:
    walkers = Crowd(towards_goal, histories((0, 0, 0), (5, 5, 1)))
    before = walkers.positions
    frames = walkers.step(np.array([[3, 4, 0], [5, 9, 0]]), np.array([1.5, 0.9]))
    assert frames.shape == (2, 219)
    np.testing.assert_allclose(walkers.positions - before, [[0.05 * 0.6, 0.05 * 0.8], [0, 0.03]], atol=1e-6)
    np.testing.assert_allclose(frames[:, [216, 218]], walkers.positions)


def test_a_crowd_walks_as_each_would_alone() -> None:
    starts, goals = [(0, 0, 0), (5, 5, 1), (-3, 2, 2)], np.array([[3, 4, 0.0], [5, 9, 1], [0, 0, -1]])
    together = Crowd(towards_goal, histories(*starts))
    alone = [Crowd(towards_goal, histories(start)) for start in starts]
    for _ in range(20):
        frames = together.step(goals)
        each = [walker.step(goal[None])[0] for walker, goal in zip(alone, goals, strict=True)]
    np.testing.assert_allclose(frames, np.stack(each), atol=1e-5)


def test_the_history_is_seen_from_the_goal() -> None:
    seen = []

    def watch(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        seen.append((frames.copy(), speed.copy()))
        return frames[:, -1]

    Crowd(watch, histories((2, 3, np.pi / 2))).step(np.array([[2, 3, np.pi / 2]]), 0.7)
    np.testing.assert_allclose(seen[0][0][0], history_of(STRIDE), atol=1e-5)
    assert seen[0][0].dtype == np.float32
    np.testing.assert_allclose(seen[0][1], [0.7])


def test_predicted_matrices_come_back_as_rotations() -> None:
    def rough(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return frames[:, -1] + np.random.default_rng(0).normal(0, 0.05, (len(frames), 219)).astype(np.float32)

    frame = Crowd(rough, histories((0, 0, 0))).step(np.zeros((1, 3)))
    matrices = to_motion(frame).rotations[0]
    np.testing.assert_allclose(matrices @ np.swapaxes(matrices, -1, -2), np.tile(np.eye(3), (24, 1, 1)), atol=1e-5)
    np.testing.assert_allclose(np.linalg.det(matrices), 1, atol=1e-5)


def test_characters_can_leave_a_crowd() -> None:
    walkers = Crowd(towards_goal, histories((0, 0, 0), (1, 0, 0), (2, 0, 0)))
    walkers.keep(np.array([True, False, True]))
    assert len(walkers) == 2
    np.testing.assert_allclose(walkers.positions[:, 0], [0, 2], atol=1e-6)


def test_a_model_that_fails_says_so() -> None:
    walkers = Crowd(lambda frames, speed: frames[:, -1] * np.nan, histories((0, 0, 0)))
    with pytest.raises(WalkError, match="not finite"):
        walkers.step(np.zeros((1, 3)))


@pytest.mark.parametrize("goals", [np.zeros((2, 3)), np.zeros((1, 2)), np.array([[0, np.nan, 0]])])
def test_goals_that_fit_nobody_are_refused(goals: np.ndarray) -> None:
    with pytest.raises(InvalidInputError, match="1 finite rows of x, z, heading"):
        Crowd(towards_goal, histories((0, 0, 0))).step(goals)


@pytest.mark.parametrize("history", [np.zeros((1, 29, 219)), np.zeros((30, 219)), np.full((1, 30, 219), np.nan)])
def test_a_bad_history_is_refused(history: np.ndarray) -> None:
    with pytest.raises(InvalidInputError, match="history"):
        Crowd(towards_goal, history)


def test_a_short_history_is_preceded_by_its_first_frame() -> None:
    motion = random_motion(4, FPS)
    history = history_of(motion)
    assert history.shape == (30, 219)
    np.testing.assert_array_equal(history[:27], np.tile(history[26], (27, 1)))
    np.testing.assert_allclose(to_motion(history[26:]).root, motion.root)


def test_another_frame_rate_is_refused_with_the_remedy() -> None:
    with pytest.raises(InvalidInputError, match=r"resample\(30\)"):
        history_of(random_motion(40, 20.0))


def test_a_number_of_characters_walks_abreast() -> None:
    walkers = crowd(FakeCharacterModels(), 3)
    np.testing.assert_allclose(walkers.positions, [[-ABREAST, 0], [0, 0], [ABREAST, 0]], atol=1e-6)


def test_characters_begin_in_stride_where_they_are_told() -> None:
    walkers = crowd(FakeCharacterModels(), [Goal(4, 5, np.pi / 2), (1, 2, 0)])
    np.testing.assert_allclose(walkers.positions, [[4, 5], [1, 2]], atol=1e-5)
    walked = to_motion(walkers.history[0])
    assert walked.root[-1, 0] - walked.root[0, 0] > 1.0  # along +X, as it faces


def test_nobody_is_no_crowd() -> None:
    with pytest.raises(InvalidInputError, match="at least one"):
        crowd(FakeCharacterModels(), 0)
