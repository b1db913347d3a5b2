"""Walkers that meet pass each other and still arrive."""

from __future__ import annotations

import numpy as np
import pytest
from fake_character_models import turns_gently
from motions import standing

from motionrt.errors import InvalidInputError
from motionrt.locomotion.avoidance import around_others
from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.starting_poses import stride_of

STAND = stride_of(standing(1, 30.0))


def nearest(starts: list[Goal], goals: np.ndarray, *, minds: bool, frames: int = 330) -> tuple[float, np.ndarray]:
    """The shortest distance between any two on their way, and how near each came to its goal."""
    crowd = Crowd(turns_gently, np.stack([history_of(uncanonicalise(STAND, start)) for start in starts]))
    shortest, best = np.inf, np.full(len(starts), np.inf)
    for _ in range(frames):
        told = around_others(crowd.positions, goals) if minds else (goals, 1.2)
        crowd.step(*told)
        apart = np.linalg.norm(crowd.positions[:, None] - crowd.positions[None], axis=-1)
        shortest = min(shortest, apart[~np.eye(len(starts), dtype=bool)].min())
        best = np.minimum(best, np.linalg.norm(crowd.positions - goals[:, :2], axis=1))
    return shortest, best


def test_two_who_walk_towards_each_other_pass() -> None:
    starts, goals = [Goal(0, 0, 0), Goal(0, 10, np.pi)], np.array([[0, 10, 0], [0, 0, np.pi]], dtype=float)
    assert nearest(starts, goals, minds=False)[0] < 0.1
    shortest, best = nearest(starts, goals, minds=True)
    assert shortest > 0.45
    assert (best < 0.3).all()


def test_four_who_cross_a_square_pass() -> None:
    turns = np.arange(4) * np.pi / 2
    starts = [Goal(-5 * np.sin(a), -5 * np.cos(a), a) for a in turns]
    goals = np.stack([5 * np.sin(turns), 5 * np.cos(turns), turns], axis=1)
    shortest, best = nearest(starts, goals, minds=True)
    assert shortest > 0.4
    assert (best < 0.3).all()


def test_who_has_nobody_ahead_goes_as_told() -> None:
    places = np.array([[0.0, 0.0], [0.0, -1.0], [9.0, 0.0]])
    goals = np.array([[0.0, 5.0, 0.3], [0.0, -6.0, 0.1], [9.0, 5.0, 0.0]])
    found, speeds = around_others(places, goals, [1.0, 1.1, 1.2])
    np.testing.assert_array_equal(found, goals)
    np.testing.assert_array_equal(speeds, [1.0, 1.1, 1.2])


def test_wrong_shapes_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="places"):
        around_others(np.zeros((2, 3)), np.zeros((2, 3)))
