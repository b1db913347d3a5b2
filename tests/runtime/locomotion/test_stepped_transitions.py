"""Transitions step: standing feet stay, displaced ones are lifted one after the other, the body goes its way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels

from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.stepped_transitions import FARTHEST, with_steps
from motionrt.motion import SMPL24, Motion

MODELS = FakeCharacterModels()
ANKLES = [SMPL24.index(f"{side}_ankle") for side in ("left", "right")]
LEGS = [SMPL24.index(f"{side}_{name}") for side in ("left", "right") for name in ("knee", "ankle", "foot")]


def glided(goal: Goal, *, down: float = 0.0) -> tuple[Motion, Motion]:
    """Somebody who stands, and a transition that glides to a goal, `down` metres lower there."""
    stand = uncanonicalise(MODELS.standing, Goal(0, 0))
    before = replace(stand, rotations=np.repeat(stand.rotations, 30, 0), root=np.repeat(stand.root, 30, 0))
    aim = uncanonicalise(MODELS.standing, goal)
    made = MODELS.transition(before, aim)
    if down:
        share = np.linspace(0, 1, made.frames + 1, dtype=np.float32)[1:]
        root = made.root - np.array([0, down, 0], np.float32) * share[:, None]
        bent = np.deg2rad(60.0) * share
        rotations = made.rotations.copy()
        for side in ("left", "right"):
            for name, turn in (("hip", -1.0), ("knee", 2.0), ("ankle", -1.0)):
                c, s = np.cos(turn * bent), np.sin(turn * bent)
                one, zero = np.ones_like(c), np.zeros_like(c)
                about_x = np.stack([one, zero, zero, zero, c, -s, zero, s, c], axis=1).reshape(-1, 3, 3)
                joint = SMPL24.index(f"{side}_{name}")
                rotations[:, joint] = rotations[:, joint] @ about_x
        made = replace(made, rotations=rotations.astype(np.float32), root=root)
    return before, made


def ankles(before: Motion, made: Motion) -> np.ndarray:
    """(F + 1, 2, 3) from the last frame before."""
    return np.concatenate([before[-1:].positions(), made.positions()])[:, ANKLES].astype(np.float64)


@pytest.mark.parametrize(
    "goal", [Goal(0, 0.5), Goal(0.3, 0.0), Goal(0, -0.3), Goal(0.1, 0.1, 0.7), Goal(-0.2, 0.3, -0.4)]
)
def test_feet_stand_or_swing_one_after_the_other_and_clear_of_the_floor(goal: Goal) -> None:
    before, made = glided(goal)
    feet = ankles(before, with_steps(before, made))
    moving = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=2) > 1e-3
    assert not moving.all(axis=1).any()  # never both
    for foot in range(2):
        runs = np.flatnonzero(np.diff(np.pad(moving[:, foot], 1).astype(int)) == 1)
        assert len(runs) == 1  # one swing
        assert feet[:, foot, 1].max() - feet[0, foot, 1] > 0.04
    glides = np.linalg.norm(np.diff(ankles(before, made)[..., [0, 2]], axis=0), axis=2) > 1e-3
    assert glides.all(axis=1).mean() > 0.5  # what was made glided on both


def test_the_last_frame_is_the_pose_and_the_body_keeps_its_way() -> None:
    before, made = glided(Goal(0.2, 0.4, 0.5))
    stepped = with_steps(before, made)
    np.testing.assert_array_equal(stepped.rotations[-1], made.rotations[-1])
    np.testing.assert_array_equal(stepped.root[-1], made.root[-1])
    np.testing.assert_allclose(stepped.root[:, [0, 2]], made.root[:, [0, 2]], atol=1e-6)
    others = [joint for joint in range(24) if joint not in LEGS]
    lower = (stepped.root - made.root)[:, None]
    np.testing.assert_allclose((stepped.positions() - lower)[:, others], made.positions()[:, others], atol=2e-3)
    assert np.abs(np.diff(stepped.positions(), axis=0)).max() < 0.2  # metres a frame: nothing jumps


def test_feet_that_are_where_they_shall_be_stay_on_the_spot() -> None:
    before, made = glided(Goal(0, 0), down=0.405)
    feet = ankles(before, with_steps(before, made))
    assert np.abs(feet[:-1] - feet[0]).max() < 0.01


def test_who_sits_down_steps_before_and_who_rises_steps_afterwards() -> None:
    before, low = glided(Goal(0, -0.3), down=0.405)
    high = before.root[-1, 1]

    def lowered(motion: Motion, first: Motion) -> np.ndarray:
        swinging = np.linalg.norm(np.diff(ankles(first, motion)[..., [0, 2]], axis=0), axis=2) > 1e-3
        return (high - motion.root[swinging.any(axis=1), 1]) / 0.405

    assert lowered(with_steps(before, low), before).max() < 0.6
    up = replace(low, rotations=low.rotations[::-1].copy(), root=low.root[::-1].copy())
    seat = replace(low, rotations=np.repeat(low.rotations[-1:], 30, 0), root=np.repeat(low.root[-1:], 30, 0))
    assert lowered(with_steps(seat, up), seat).max() < 0.6


def test_feet_that_go_farther_than_a_step_take_two_each() -> None:
    before, made = glided(Goal(0, FARTHEST + 0.3))
    feet = ankles(before, with_steps(before, made))
    moving = np.linalg.norm(np.diff(feet[..., [0, 2]], axis=0), axis=2) > 5e-3
    assert not moving.all(axis=1).any()
    swings = [np.count_nonzero(np.diff(np.pad(moving[:, foot], 1).astype(int)) == 1) for foot in range(2)]
    assert swings == [2, 2]


def test_feet_that_would_need_more_go_as_they_did() -> None:
    before, made = glided(Goal(0, 2 * FARTHEST + 0.2))
    assert with_steps(before, made) is made
