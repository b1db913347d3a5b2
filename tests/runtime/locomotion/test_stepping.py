"""From one stand to another by steps: feet are lifted, set down, and stay where they stand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import standing

from motionrt.errors import InvalidInputError
from motionrt.locomotion.footfalls import plan_steps
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.starting_poses import standing as shipped
from motionrt.locomotion.starting_poses import stride_of
from motionrt.locomotion.stepping import step_to
from motionrt.motion import SMPL24, Motion

FPS = 30.0
ANKLES = [SMPL24.index("left_ankle"), SMPL24.index("right_ankle")]
TOES = [SMPL24.index("left_foot"), SMPL24.index("right_foot")]


@pytest.fixture(scope="module")
def stand() -> Motion:
    pose = shipped()
    return pose if pose is not None else stride_of(standing(1, FPS))


def speeds(motion: Motion, joints: list[int]) -> np.ndarray:
    """(F - 1, joints) m/s over the ground."""
    return np.linalg.norm(np.diff(motion.positions()[:, joints][..., [0, 2]], axis=0), axis=-1) * FPS


@settings(max_examples=15, deadline=None)
@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(-3.1, 3.1))
def test_it_arrives_exactly_whatever_the_way(x: float, z: float, turn: float) -> None:
    stand = shipped()
    assert stand is not None
    target = uncanonicalise(stand, Goal(x, z, turn))
    made = step_to(stand, target).motion
    np.testing.assert_allclose(made.positions()[-1], target.positions()[0], atol=1e-5)
    pelvis = np.linalg.norm(np.diff(made.root, axis=0), axis=-1) * FPS
    assert pelvis.max(initial=0.0) < 2.0


@pytest.mark.parametrize("goal", [Goal(0, 0.8), Goal(0.7, 0), Goal(0, -0.9), Goal(0, 0, 2.0), Goal(-0.4, 0.5, -1.0)])
def test_every_displaced_foot_is_lifted_and_no_standing_one_slides(stand: Motion, goal: Goal) -> None:
    made = step_to(stand, uncanonicalise(stand, goal)).motion
    height = made.positions()[:, ANKLES, 1]
    assert (height.max(axis=0) - height[0] > 0.04).all()
    low = made.positions()[1:, TOES, 1] < 0.02
    assert speeds(made, TOES)[low].mean() < 0.03
    assert ((speeds(made, TOES) < 0.02).any(axis=1)).mean() > 0.97  # one foot stands nearly always


def test_the_first_foot_leaves_the_ground_within_four_tenths_of_a_second(stand: Motion) -> None:
    made = step_to(stand, uncanonicalise(stand, Goal(0, 1.0))).motion
    rise = made.positions()[:, ANKLES, 1] - made.positions()[0, ANKLES, 1]
    assert np.flatnonzero((rise > 0.02).any(axis=1))[0] < 0.4 * FPS


def test_steps_are_mirrored_when_the_goal_is(stand: Motion) -> None:
    both = [step_to(stand, uncanonicalise(stand, Goal(x, 0.2, 0.5 * x))).landings for x in (0.8, -0.8)]
    assert both[0] == both[1]
    left, right = plan_steps(0.1, 0.8, 0.4, (True, True)), plan_steps(0.1, -0.8, -0.4, (True, True))
    assert [step.foot for step in left] == [1 - step.foot for step in right]
    assert [step.share for step in left] == [step.share for step in right]


def test_landings_are_frames_in_which_both_feet_stand(stand: Motion) -> None:
    made = step_to(stand, uncanonicalise(stand, Goal(0, 1.5)))
    heights = made.motion.positions()[np.array(made.landings) - 1][:, TOES, 1]
    assert np.abs(heights - stand.positions()[0, TOES, 1]).max() < 0.01
    assert made.landings[-1] == made.motion.frames


def test_who_is_there_already_only_settles(stand: Motion) -> None:
    made = step_to(stand, uncanonicalise(stand, Goal(0.005, 0, 0.01))).motion
    assert (made.positions()[:, ANKLES, 1].max(axis=0) - stand.positions()[0, ANKLES, 1] < 0.01).all()


def test_another_frame_rate_is_refused(stand: Motion) -> None:
    with pytest.raises(InvalidInputError, match="resample"):
        step_to(standing(2, 20.0), stand)
