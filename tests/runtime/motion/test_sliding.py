"""Feet that slide through a contact take steps; feet that stand or swing are left alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from gaits import gait
from motions import standing

from motionrt.errors import InvalidInputError
from motionrt.metrics import foot_skate
from motionrt.motion import SMPL24, Motion, Skeleton
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.feet.sliding import LIFT, step_where_sliding

TOES = [10, 11]
FRAMES = 150


def gliding(metres_a_second: float, sideways: bool = True) -> Motion:
    """A statue that glides along the floor at 30 fps."""
    still = standing(FRAMES, fps=30)
    way = np.linspace(0, metres_a_second * FRAMES / 30, FRAMES)
    axis = np.array([1, 0, 0] if sideways else [0, 0, 1], np.float32)
    return replace(still, root=(still.root + way[:, None] * axis).astype(np.float32))


@pytest.mark.parametrize("sideways", [True, False])
@pytest.mark.parametrize("speed", [0.15, 0.4, 0.6])
def test_a_statue_that_glides_takes_steps(speed: float, sideways: bool) -> None:
    glides = gliding(speed, sideways)
    steps = lock_feet(step_where_sliding(glides))
    assert foot_skate(steps.positions()) < 0.15 * foot_skate(glides.positions())
    lifted = steps.positions()[:, TOES, 1] > 0.7 * LIFT
    begins = (np.diff(lifted.astype(int), axis=0) == 1).sum(axis=0)
    assert (begins >= 2).all()  # each foot, more than once


def test_feet_go_in_turn_and_stay_near_where_they_slid() -> None:
    glides = gliding(0.4)
    steps = step_where_sliding(glides)
    aloft = steps.positions()[:, TOES, 1] > 0.3 * LIFT
    assert not aloft.all(axis=1).any()
    off = np.linalg.norm((steps.positions() - glides.positions())[:, TOES], axis=-1)
    assert off.max() < 0.35
    assert np.allclose(steps.root[:, [0, 2]], glides.root[:, [0, 2]])


def test_who_stands_or_walks_is_left_alone() -> None:
    for motion in (standing(60), gait()[0]):
        assert step_where_sliding(motion) is motion


def test_who_is_low_drags_the_feet() -> None:
    glides = gliding(0.4)
    rotations = glides.rotations.copy()
    rotations[:, 0] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # on the back
    lies = replace(glides, rotations=rotations).grounded()
    assert lies.positions()[:, TOES, 1].max() < 0.2
    assert step_where_sliding(lies) is lies


def test_another_skeleton_is_refused() -> None:
    other = replace(standing(5), skeleton=Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets * 2))
    with pytest.raises(InvalidInputError, match="smpl24"):
        step_where_sliding(other)


def test_who_walks_with_neither_foot_standing_takes_steps() -> None:
    glides = gliding(1.2)  # too fast for a contact
    assert step_where_sliding(glides) is glides
    steps = lock_feet(step_where_sliding(glides, walking=True))
    assert foot_skate(steps.positions()) < 0.3 * foot_skate(glides.positions())
    aloft = steps.positions()[:, TOES, 1] > 0.3 * LIFT
    assert not aloft.all(axis=1).any()


def test_who_leaps_and_runs_is_left_alone() -> None:
    leaps = gliding(1.2)
    up = np.abs(np.sin(np.arange(FRAMES) / 5))[:, None] * np.array([0, 0.3, 0], np.float32)
    leaping = replace(leaps, root=(leaps.root + up).astype(np.float32))
    assert step_where_sliding(leaping, walking=True) is leaping
    runs = gliding(3.0)
    assert step_where_sliding(runs, walking=True) is runs
