"""What no pose can do, and what is no question: errors with numbers that can be worked out by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from toy_prior import ToyPrior

from motionrt.errors import InvalidInputError, ReachError
from motionrt.locomotion.posing import solve_pose
from motionrt.locomotion.posing.reach import longest_reach, overstretched

PRIOR = ToyPrior()
FEET = {"left_foot": (0.1, 0.0, 0.1), "right_foot": (-0.1, 0.0, 0.1)}
# pelvis to hip, thigh, shank, ankle to ball, from the table of offsets
LEG = np.hypot(0.085, 0.075) + 0.405 + np.hypot(0.410, 0.010) + np.hypot(0.065, 0.135)


def test_the_longest_reach_is_the_bones_between_two_joints() -> None:
    assert longest_reach("left_foot", "right_foot") == pytest.approx(2 * LEG, abs=1e-6)
    assert longest_reach("pelvis", "right_foot") == pytest.approx(LEG, abs=1e-6)
    assert longest_reach("left_wrist", "left_elbow") == pytest.approx(0.25, abs=1e-6)
    assert longest_reach("left_hand", "left_hand") == 0.0
    assert longest_reach("left_collar", "neck") == pytest.approx(
        np.linalg.norm([0.065, 0.12, -0.005]) + np.hypot(0.205, 0.01), abs=1e-6
    )


def test_feet_three_metres_apart_are_missed_by_what_the_legs_lack() -> None:
    with pytest.raises(ReachError) as caught:
        solve_pose({"left_foot": (1.5, 0, 0), "right_foot": (-1.5, 0, 0)}, PRIOR)
    lacking = 100 * (3.0 - 2 * LEG)  # 84.3 cm; two misses share at least that
    assert lacking == pytest.approx(84.3, abs=0.05)
    miss = caught.value.miss_cm
    assert set(miss) == {"left_foot", "right_foot"}
    assert lacking <= sum(miss.values()) < lacking + 60
    assert miss["left_foot"] == pytest.approx(miss["right_foot"], abs=2.0)
    message = str(caught.value)
    assert f"left_foot by {miss['left_foot']:.1f} cm" in message
    assert "300 cm apart but the skeleton spans at most 216 cm, move them 84.3 cm closer" in message


def test_a_hand_four_metres_up_is_missed_by_at_least_what_body_and_arm_lack() -> None:
    with pytest.raises(ReachError, match="left_foot and left_hand are 401 cm apart") as caught:
        solve_pose({**FEET, "left_hand": (0.0, 4.0, 0.3)}, PRIOR)
    lacking = 100 * (np.linalg.norm([0.1, 4.0, 0.2]) - longest_reach("left_hand", "left_foot"))
    assert caught.value.miss_cm["left_hand"] + caught.value.miss_cm["left_foot"] >= lacking


def test_a_body_that_would_hang_in_the_air_is_refused_with_the_remedy() -> None:
    with pytest.raises(ReachError, match=r"feet would hang \d+\.\d cm above the ground, .* floor=None"):
        solve_pose({"left_hand": (0.0, 4.0, 0.0)}, PRIOR)


def test_contradictory_keypoints_within_reach_of_each_other_are_refused_too() -> None:
    points = {"left_elbow": (0.0, 1.0, 0.0), "left_wrist": (0.0, 1.0, 0.1)}  # 10 cm apart on a bone of 25
    assert not overstretched(points)
    with pytest.raises(
        ReachError, match="move the keypoints towards each other, give fewer, or raise tolerance_cm"
    ) as c:
        solve_pose(points, PRIOR, tolerance_cm=4.0)
    assert sum(c.value.miss_cm.values()) >= 15 - 0.1


def test_a_larger_tolerance_accepts_the_nearest_pose() -> None:
    points = {"left_elbow": (0.0, 1.0, 0.0), "left_wrist": (0.0, 1.0, 0.1)}
    solution = solve_pose(points, PRIOR, tolerance_cm=12.0)
    assert 7.4 < solution.mean_error_cm < 12.0


@pytest.mark.parametrize(
    ("keypoints", "options", "message"),
    [
        ({}, {}, "at least one keypoint"),
        ({"tail": (0, 0, 0)}, {}, "no joint 'tail'; joints are: pelvis"),
        ({"pelvis": (0, 1)}, {}, "keypoint 'pelvis' must be three finite numbers"),
        ({"pelvis": (0, np.nan, 0)}, {}, "keypoint 'pelvis' must be three finite numbers"),
        ({"pelvis": "high"}, {}, "keypoint 'pelvis' must be three finite numbers"),
        ({"pelvis": (0, 1, 0)}, {"heading": np.inf}, "heading must be a finite number"),
        ({"pelvis": (0, 1, 0)}, {"floor": np.nan}, "floor must be a finite number"),
        ({"pelvis": (0, 1, 0)}, {"tolerance_cm": -1}, "tolerance_cm must be 0 or more"),
        ({"pelvis": (0, 1, 0)}, {"tolerance_cm": np.nan}, "tolerance_cm must be 0 or more"),
        ({"pelvis": (0, 1, 0)}, {"starts": 0}, "must be 1 or more"),
    ],
)
def test_what_is_no_question_is_refused(keypoints: Any, options: Any, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        solve_pose(keypoints, PRIOR, **options)


@pytest.mark.parametrize("surfaces", ["a wall", [1.0, 2.0], [[np.nan, 0.0, 0.0]], [[0.0, 1.0]], [None]])
def test_surfaces_that_are_no_points_are_refused(surfaces: Any) -> None:
    with pytest.raises(InvalidInputError, match="surfaces must be"):
        solve_pose(FEET, PRIOR, surfaces=surfaces)
