"""Measures of single feet, on feet that are moved by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.metrics.footing import footing
from motionrt.metrics.locomotion import foot_skate
from motionrt.motion import SMPL24

LEFT, RIGHT = SMPL24.index("left_foot"), SMPL24.index("right_foot")


def feet(left: float, right: float, height: float = 0.0, frames: int = 31) -> np.ndarray:
    """Toes that slide along Z at so many m/s, at 30 fps."""
    joints = np.zeros((frames, 24, 3))
    time = np.arange(frames) / 30
    joints[:, LEFT, 2], joints[:, RIGHT, 2] = left * time, right * time
    joints[:, [LEFT, RIGHT], 1] = height
    return joints


@given(st.floats(0, 2), st.floats(0, 2), st.floats(0, 0.024))
def test_each_foot_slides_by_itself_and_the_sum_is_the_papers(left: float, right: float, height: float) -> None:
    joints = feet(left, right, height)
    found, weight = footing(joints, 30.0), 2 - 2 * height / 0.025
    assert found.left_skate_cm == pytest.approx(left * 100 / 30 * weight, abs=1e-6)
    assert found.right_skate_cm == pytest.approx(right * 100 / 30 * weight, abs=1e-6)
    assert found.skate_cm == pytest.approx(foot_skate(joints), abs=1e-9)
    assert found.contact_speed == pytest.approx((left + right) / 2, abs=1e-6)
    assert found.contact_share == 1.0


def test_feet_in_the_air_and_feet_that_rise_are_at_no_contact() -> None:
    assert footing(feet(1.0, 1.0, 0.03), 30.0).contact_share == 0.0
    rising = feet(1.0, 1.0)
    rising[:, RIGHT, 1] = np.linspace(0, 0.2, len(rising))
    assert footing(rising, 30.0).contact_share == pytest.approx(0.5)


@given(st.floats(0, 2), st.floats(0.05, 1.2))
def test_the_tip_of_the_right_foot_slides_with_a_flat_sole_and_lifts_with_a_pitched_one(v: float, up: float) -> None:
    sole = SMPL24.offsets[RIGHT].astype(np.float64)
    joints = feet(0.0, v)
    joints[:, SMPL24.index("right_ankle")] = joints[:, RIGHT] - sole
    assert footing(joints, 30.0).right_tip_cm == pytest.approx(v * 200 / 30, abs=1e-6)
    c, s = np.cos(up), np.sin(up)  # toes up, about the ball
    joints[:, SMPL24.index("right_ankle")] = joints[:, RIGHT] - np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ sole
    raised = 7 * np.sin(up)
    weight = 2 - 2 * raised / 2.5 if raised <= 2.5 else 0.0
    assert footing(joints, 30.0).right_tip_cm == pytest.approx(v * 100 / 30 * weight, abs=0.05)
    joints[:, SMPL24.index("right_ankle")] = joints[:, RIGHT] - np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ sole
    assert footing(joints, 30.0).right_tip_cm == pytest.approx(v * 200 / 30, abs=1e-6)  # heel up: toes stay level


def test_the_difference_of_the_feet_is_a_share_of_the_larger() -> None:
    assert footing(feet(0.4, 0.3), 30.0).difference == pytest.approx(0.25)
    assert footing(feet(0.0, 0.0), 30.0).difference == 0.0


@pytest.mark.parametrize(("shape", "fps"), [((5, 23, 3), 30.0), ((1, 24, 3), 30.0), ((5, 24, 3), 0.0)])
def test_wrong_arguments_are_refused(shape: tuple[int, ...], fps: float) -> None:
    with pytest.raises(InvalidInputError, match="footing needs"):
        footing(np.zeros(shape), fps)
