"""Which of several motions is taken: not one that breaks off in the middle of a kick or a jump."""

from __future__ import annotations

import numpy as np
import pytest
from motions import standing, walking
from scipy.spatial.transform import Rotation

from motionrt.motion import Motion
from motionrt.synthesis.choosing import best, breaks_off
from motionrt.synthesis.timeline import Line

TIMES = np.linspace(0, 2, 61)


def kick(at: float) -> Motion:
    """The left leg swings up to the front and down again within half a second; its middle is at a time."""
    still = standing(61, 30.0)
    rotations = still.rotations.copy()
    swing = -1.6 * np.exp(-(((TIMES - at) / 0.18) ** 2))
    rotations[:, still.skeleton.index("left_hip")] = Rotation.from_rotvec(swing[:, None] * [1, 0, 0]).as_matrix()
    return Motion(rotations, still.root, 30.0)


def jump(at: float) -> Motion:
    still = standing(61, 30.0)
    up = np.maximum(0, 0.4 - 4.9 * (TIMES - at) ** 2)
    return Motion(still.rotations, still.root + (up[:, None] * [0, 1, 0]).astype(np.float32), 30.0)


@pytest.mark.parametrize("late", [kick(1.9), kick(2.1), jump(1.9), jump(2.1)])
def test_a_motion_that_ends_in_the_middle_of_a_kick_or_a_jump_breaks_off(late: Motion) -> None:
    assert breaks_off(late)


@pytest.mark.parametrize("whole", [kick(1.0), jump(1.0), walking(60, 30.0), standing(60, 30.0), standing(1)])
def test_a_motion_that_comes_to_its_end_does_not(whole: Motion) -> None:
    assert not breaks_off(whole)


def test_of_two_kicks_the_whole_one_is_taken_though_the_other_is_liked_a_little_better() -> None:
    kicks, line = [kick(1.95), kick(1.0)], (Line("kick with the left foot", 0, 2),)
    assert best(kicks, line, lambda text, motion: 0.6 if motion.root is kicks[0].root else 0.5) == 1
