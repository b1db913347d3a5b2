"""Which waypoint comes next."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.errors import InvalidInputError
from motionrt.locomotion.waypoints import WaypointTargets

STRAIGHT = np.array([[0.0, 1, 0], [0, 2, 0], [0, 3, 0]])  # along +Z


def test_a_waypoint_is_left_behind_inside_the_radius() -> None:
    routes = WaypointTargets([STRAIGHT], radius=0.4)
    np.testing.assert_array_equal(routes.goals(np.array([[0.3, 0.5]])), STRAIGHT[:1])
    np.testing.assert_array_equal(routes.goals(np.array([[0.3, 0.8]])), STRAIGHT[1:2])


def test_a_waypoint_that_was_passed_at_some_distance_is_walked_back_to() -> None:
    routes = WaypointTargets([STRAIGHT], radius=0.4)
    np.testing.assert_array_equal(routes.goals(np.array([[0.5, 1.05]])), STRAIGHT[:1])


def test_a_corner_is_not_cut_by_walking_up_to_it() -> None:
    corner = np.array([[0.0, 6, np.pi / 2], [1, 6, np.pi / 2]])  # come along +Z, go on along +X
    routes = WaypointTargets([np.concatenate([[[0.0, 4, 0]], corner])], radius=0.4)
    for z in (4.0, 4.9, 5.2, 5.5):
        np.testing.assert_array_equal(routes.goals(np.array([[0.1, z]])), corner[:1])
    np.testing.assert_array_equal(routes.goals(np.array([[0.25, 6.1]])), corner[1:])


def test_a_waypoint_that_was_missed_by_far_is_walked_back_to() -> None:
    routes = WaypointTargets([STRAIGHT], radius=0.4)
    np.testing.assert_array_equal(routes.goals(np.array([[2.0, 1.5]])), STRAIGHT[:1])


def test_several_waypoints_inside_the_radius_are_left_at_once_and_the_last_stays() -> None:
    routes = WaypointTargets([STRAIGHT], radius=1.5)
    np.testing.assert_array_equal(routes.goals(np.array([[0.0, 2.0]])), STRAIGHT[2:])
    assert routes.ends().tolist() == [True]
    np.testing.assert_array_equal(routes.goals(np.array([[0.0, 9.0]])), STRAIGHT[2:])


def test_every_character_has_its_own_route() -> None:
    beside = STRAIGHT + np.array([10.0, 0, 0])
    routes = WaypointTargets([STRAIGHT, beside])
    np.testing.assert_array_equal(routes.goals(np.array([[0.0, 0.9], [0, 0]])), [STRAIGHT[1], beside[0]])
    assert routes.index == [1, 0]


@pytest.mark.parametrize("waypoints", [[], [np.zeros((0, 2))], [np.zeros(3)]])
def test_a_route_without_waypoints_is_refused(waypoints: list[np.ndarray]) -> None:
    with pytest.raises(InvalidInputError, match="x, z, heading"):
        WaypointTargets(waypoints)
