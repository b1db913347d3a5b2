"""The measures of walking against closed forms."""

from __future__ import annotations

import json

import numpy as np
import pytest
from gaits import gait
from hypothesis import given
from hypothesis import strategies as st
from motions import standing
from scipy.spatial.transform import Rotation

from motionrt import metrics
from motionrt.errors import InvalidInputError
from motionrt.metrics.locomotion import foot_skates, path_distances

LEFT_TOE, RIGHT_TOE = 10, 11


def one_foot(speed_cm: float, height_cm: float, frames: int = 11) -> np.ndarray:
    """The left toe slides diagonally by ``speed_cm`` a frame at a height; the right one is far up."""
    positions = np.zeros((frames, 24, 3))
    positions[:, RIGHT_TOE, 1] = 1.0
    positions[:, LEFT_TOE, 1] = height_cm / 100
    positions[:, LEFT_TOE, 0] = 0.6 * speed_cm / 100 * np.arange(frames)
    positions[:, LEFT_TOE, 2] = 0.8 * speed_cm / 100 * np.arange(frames)
    return positions


@given(st.floats(0, 30), st.integers(2, 40))
def test_a_foot_that_slides_on_the_floor_skates_twice_its_speed(speed: float, frames: int) -> None:
    assert metrics.foot_skate(one_foot(speed, 0.0, frames)) == pytest.approx(2 * speed, abs=1e-9)


def test_the_weight_falls_in_a_straight_line_to_zero_at_the_height_of_two_and_a_half_centimetres() -> None:
    heights = [0.0, 0.625, 1.25, 1.875, 2.5, 2.6, 10.0, -1.0]
    found = [metrics.foot_skate(one_foot(3.0, height)) for height in heights]
    assert found == pytest.approx([6, 4.5, 3, 1.5, 0, 0, 0, 6], abs=1e-9)


def test_skate_of_both_feet_adds_up_and_is_divided_by_the_frames() -> None:
    positions = one_foot(2.0, 0.0)
    positions[:, RIGHT_TOE] = positions[:, LEFT_TOE]
    assert metrics.foot_skate(positions) == pytest.approx(8.0)
    positions[6:] = positions[5]  # stands for the second half
    assert metrics.foot_skate(positions) == pytest.approx(4.0)
    assert foot_skates(positions) == pytest.approx([8.0] * 5 + [0.0] * 5)


def test_heights_count_from_the_floor_that_is_given() -> None:
    positions = one_foot(2.0, 1.25)
    assert metrics.foot_skate(positions, floor=0.0125) == pytest.approx(4.0)


def test_standing_does_not_skate_and_a_clean_gait_hardly_does() -> None:
    assert metrics.foot_skate(standing(10).positions()) == 0
    clean = metrics.foot_skate(gait()[0].positions())  # only while a foot leaves and lands
    assert clean < 1.0
    sliding = metrics.foot_skate(gait(slide=0.3)[0].positions())  # 1 cm a frame on 1.2 feet
    assert sliding == pytest.approx(2 * 1.0 * 1.2 + clean, rel=0.15)


def test_jerk_of_a_cubic_is_its_third_derivative_at_any_rate() -> None:
    for fps in (20.0, 30.0, 120.0):
        time = np.arange(20)[:, None, None] / fps
        positions = np.ones((1, 24, 3)) * time**3 * np.array([1.0, 2.0, 2.0])  # 6 m/s^3 times (1, 2, 2)
        assert metrics.jerk(positions, fps) == pytest.approx(18.0, rel=1e-6)


def test_path_deviation_is_the_distance_to_the_nearest_point_of_the_polyline() -> None:
    path = np.array([[0, 0], [4, 0], [4, 3]])
    root = np.array([[2, 1], [4, 0], [5, 1.5], [-3, -4], [4, 5], [3.5, 2]])
    assert path_distances(root, path) == pytest.approx([1, 0, 1, 5, 2, 0.5])
    found = metrics.path_deviation(root, path)
    assert (found.mean, found.max) == pytest.approx((9.5 / 6, 5))
    assert metrics.path_deviation(root, path[:1]).max == pytest.approx(np.hypot(4, 5))


def test_a_long_path_is_measured_in_pieces_with_the_same_result() -> None:
    angle = np.linspace(0, 6, 1000)
    root = np.stack([10 * np.cos(angle), 10 * np.sin(angle)], axis=1)
    assert path_distances(root, root * 1.1)[::7].max() == pytest.approx(1.0, abs=0.02)
    assert path_distances(root, root).max() == pytest.approx(0, abs=1e-9)


def test_waypoints_are_reached_within_the_radius() -> None:
    root = np.stack([np.linspace(0, 10, 101), np.zeros(101)], axis=1)
    waypoints = [[1, 0.1], [5, 0.4], [12, 0]]
    assert metrics.waypoint_distances(root, waypoints) == pytest.approx([0.1, 0.4, 2])
    assert metrics.waypoints_reached(root, waypoints, 0.35) == pytest.approx(1 / 3)
    assert metrics.waypoints_reached(root, waypoints, 0.5) == pytest.approx(2 / 3)


def test_drift_compares_the_last_seconds_with_the_first() -> None:
    values = np.r_[np.zeros(60), np.full(100, 7.0), np.full(60, 3.0)]
    assert metrics.drift(values, fps=30, seconds=2) == pytest.approx(3.0)
    assert metrics.drift([1.0, 2.0, 5.0], fps=30, seconds=30) == pytest.approx(4.0)


def test_end_error_in_centimetres_and_degrees() -> None:
    target = standing(1).positions()[0].astype(float)
    moved = target + np.array([0.03, 0, 0.04])
    found = metrics.end_error(moved, target)
    assert (found.joints_cm, found.root_cm, found.heading_deg) == pytest.approx((5, 5, 0), abs=1e-6)
    for degrees in (20.0, -150.0):
        turned = (target - target[0]) @ Rotation.from_euler("y", degrees, degrees=True).as_matrix().T + target[0]
        found = metrics.end_error(turned, target)
        assert (found.root_cm, found.heading_deg) == pytest.approx((0, abs(degrees)), abs=1e-4)
        assert found.joints_cm > 5


def test_keypoint_error_is_the_mean_distance() -> None:
    assert metrics.keypoint_error([[0, 0, 0], [1, 1, 1]], [[0, 0.03, 0.04], [1, 1, 1]]) == pytest.approx(2.5)


def test_the_record_of_a_walk_holds_every_measure_and_goes_to_json() -> None:
    motion, _ = gait(seconds=10, fps=30)
    path = [[0.1, 0], [0.1, 6]]
    found = metrics.LocomotionMeasures.of(motion.positions(), 30, path, [[0, 1], [0, 3], [3, 3]], window_s=3)
    assert (found.frames, found.seconds) == (300, 10)
    assert found.distance_m == pytest.approx(0.6 * 299 / 30, rel=1e-3)
    assert found.standing_height_m == pytest.approx(0.9, abs=1e-6)
    assert found.height_drift_cm == pytest.approx(0, abs=1e-4)
    assert (found.path_deviation_m, found.path_deviation_max_m) == pytest.approx((0.1, 0.1), abs=1e-5)
    assert found.path_deviation_drift_m == pytest.approx(0, abs=1e-5)
    assert found.goal_distance_m == pytest.approx(np.hypot(0.1, 0.02), abs=1e-3)
    assert found.waypoints_reached == pytest.approx(2 / 3)
    assert found.foot_skate_cm == metrics.foot_skate(motion.positions())
    assert json.loads(json.dumps(found.as_dict()))["jerk"] == pytest.approx(found.jerk)


def test_a_walk_without_a_path_has_no_measures_of_one() -> None:
    found = metrics.LocomotionMeasures.of(gait()[0].positions(), 30).as_dict()
    missing = {name for name, value in found.items() if value is None}
    of_a_path = {"path_deviation_m", "path_deviation_max_m", "path_deviation_drift_m", "goal_distance_m"}
    assert missing == of_a_path | {"waypoints_reached", "waypoint_distance_max_m"}


def test_wrong_shapes_are_named() -> None:
    with pytest.raises(InvalidInputError, match=r"\(frames >= 2, 24, 3\)"):
        metrics.foot_skate(np.zeros((5, 22, 3)))
    with pytest.raises(InvalidInputError, match="frames >= 4"):
        metrics.jerk(np.zeros((3, 24, 3)), 30)
    with pytest.raises(InvalidInputError, match="path_xz"):
        metrics.path_deviation(np.zeros((5, 2)), np.zeros((5, 3)))
    with pytest.raises(InvalidInputError, match="one number per frame"):
        metrics.drift(np.zeros((5, 2)), 30)
    with pytest.raises(InvalidInputError, match="one shape"):
        metrics.keypoint_error(np.zeros((5, 3)), np.zeros((4, 3)))
