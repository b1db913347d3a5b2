"""APE, AVE and TEMOS score against numbers worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt import metrics
from motionrt.errors import InvalidInputError
from motionrt.metrics import Body
from motionrt.motion.transforms import moved, turned


def body(joints: list, yaw: float = 0.0) -> Body:
    points = np.array(joints, float)
    return Body(points, np.full(len(points), yaw))


# two joints: the pelvis, and a hand one metre above it
STILL = body([[[0, 1, 0], [0, 2, 0]]] * 2)


def test_a_body_that_stands_elsewhere_errs_by_its_distance_and_not_in_its_own_frame() -> None:
    aside = body([[[3, 1, 4], [3, 2, 4]]] * 2)
    found = metrics.ape([aside], [STILL])
    assert (found.root, found.trajectory, found.mean_local, found.mean_global) == pytest.approx((5, 5, 0, 5))


def test_height_counts_for_the_root_and_the_local_joints_but_not_for_the_trajectory() -> None:
    higher = body([[[0, 1.5, 0], [0, 2.5, 0]]] * 2)
    found = metrics.ape([higher], [STILL])
    assert (found.root, found.trajectory, found.mean_local, found.mean_global) == pytest.approx((0.5, 0, 0.5, 0.5))


def test_a_moved_hand_counts_for_the_joints_and_the_frames_that_move_it() -> None:
    waving = body([[[0, 1, 0], [0, 2, 0]], [[0, 1, 0], [0.6, 2, 0.8]]])  # 1 m away in one of two frames
    found = metrics.ape([waving], [STILL])
    assert (found.root, found.trajectory, found.mean_local, found.mean_global) == pytest.approx((0, 0, 0.5, 0.25))


def test_frames_of_all_motions_weigh_alike() -> None:
    long, far = body([[[0, 1, 0], [0, 2, 0]]] * 6), body([[[2, 1, 0], [2, 2, 0]]] * 2)
    assert metrics.ape([long, far], [long, STILL]).root == pytest.approx(2 * 2 / 8)


def test_variance_error_is_the_distance_of_the_variances_mean_over_motions() -> None:
    # x = -1, 0, 1: variance 1 with F - 1; z = -2, 0, 2: variance 4; the truth stands still
    going = body([[[x, 1, 2 * x], [x, 2, 2 * x]] for x in (-1, 0, 1)])
    still = body([[[0, 1, 0], [0, 2, 0]]] * 3)
    found = metrics.ave([going], [still])
    assert found.root == found.trajectory == found.mean_global == pytest.approx(17**0.5)
    assert found.mean_local == pytest.approx(0)
    assert metrics.ave([going, still], [still, still]).root == pytest.approx(17**0.5 / 2)


def test_variances_are_those_of_time_not_of_place() -> None:
    motion = random_motion(40)
    away = moved(motion, np.array([5, 0, -3], np.float32))
    found = metrics.ave([Body.of(away)], [Body.of(motion)])
    assert max(found.as_dict().values()) < 1e-5
    assert metrics.ape([Body.of(away)], [Body.of(motion)]).root == pytest.approx(34**0.5, rel=1e-5)


@given(st.floats(-3.1, 3.1), st.floats(-4, 4))
def test_the_body_s_own_frame_knows_neither_place_nor_heading(yaw: float, x: float) -> None:
    motion = walking(12, turn=0.7)
    other = moved(turned(motion, yaw), np.array([x, 0, 1], np.float32))
    np.testing.assert_allclose(Body.of(other).local(), Body.of(motion).local(), atol=2e-5)


def test_the_local_joints_are_turned_back_by_the_heading() -> None:
    joints = standing(1).positions()[:, :22].astype(float)
    turn = Rotation.from_euler("y", 0.8).as_matrix()
    around = Body(joints @ turn.T, np.array([0.8]))
    np.testing.assert_allclose(around.local(), (joints - joints[:, :1] * [1, 0, 1])[:, 1:], atol=1e-6)


def test_hands_are_left_out() -> None:
    assert Body.of(standing(3)).joints.shape == (3, 22, 3)


def test_temos_score_of_equal_orthogonal_and_opposite_features() -> None:
    truth = [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 2.0]]
    found = [[3.0, 0.0], [0.0, 2.0], [-1.0, 0.0], [1.0, 1.0]]
    assert metrics.temos_scores(found, truth) == pytest.approx([1, 0.5, 0, (1 + 0.5**0.5) / 2])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: metrics.ape([], []), "at least one"),
        (lambda: metrics.ape([STILL], [STILL, STILL]), "as many motions as truths"),
        (lambda: metrics.ape([body([[[0, 1, 0], [0, 2, 0]]] * 3)], [STILL]), "trim them"),
        (lambda: metrics.ave([body([[[0, 1, 0], [0, 2, 0]]])], [body([[[0, 1, 0], [0, 2, 0]]])]), "two frames"),
        (lambda: metrics.temos_scores([[1.0]], [[1.0, 2.0]]), "one shape"),
        (lambda: metrics.temos_scores([[0.0]], [[1.0]]), "no direction"),
        (lambda: Body(np.zeros((4, 22, 3)), np.zeros(3)), "a body needs"),
    ],
)
def test_what_cannot_be_compared_is_refused(call, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        call()
