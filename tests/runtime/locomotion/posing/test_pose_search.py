"""The pieces of the search: yaw, placement, Jacobian, and the terms of the objective."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from toy_prior import ToyPrior, positions_by_scipy

from motionrt.locomotion.posing.body import Bodies, positions
from motionrt.locomotion.posing.objective import Objective
from motionrt.locomotion.posing.search import Search
from motionrt.locomotion.posing.starting import best_starts, fitted_root, fitted_yaw
from motionrt.locomotion.posing.targets import targets_of
from motionrt.locomotion.posing.yaw import pelvis_yaw, without_yaw
from motionrt.motion import SMPL24

PRIOR = ToyPrior()
ANGLE = st.floats(-1.4, 1.4)


@given(st.floats(-3.1, 3.1), ANGLE, ANGLE)
def test_yaw_and_tilt_make_the_pelvis(yaw: float, bend: float, roll: float) -> None:
    tilt = Rotation.from_rotvec([0, 0, roll]) * Rotation.from_rotvec([bend, 0, 0])
    pelvis = (Rotation.from_euler("Y", yaw) * tilt).as_matrix()
    assert pelvis_yaw(pelvis) == pytest.approx(yaw, abs=1e-9)
    np.testing.assert_allclose(without_yaw(pelvis), tilt.as_matrix(), atol=1e-7)


def test_a_deep_bend_does_not_change_the_yaw() -> None:
    """The forward axis of a pelvis that bends by 100 degrees points backwards and down; its left axis stays."""
    bent = Rotation.from_euler("YX", [0.4, np.deg2rad(100)]).as_matrix()
    assert pelvis_yaw(bent) == pytest.approx(0.4)


def test_bodies_are_placed_as_scipy_places_them() -> None:
    latents = np.random.default_rng(0).normal(size=(3, 32)) * 0.5
    rotations = PRIOR.decode(latents)
    root, yaw = np.random.default_rng(1).normal(size=(3, 3)), np.array([0.3, -2.0, 3.0])
    placed = Bodies(latents, positions(rotations)).placed(root, yaw)
    for i in range(3):
        turned = rotations[i].copy()
        turned[0] = Rotation.from_euler("Y", yaw[i]).as_matrix() @ turned[0]
        np.testing.assert_allclose(placed[i], positions_by_scipy(turned, root[i]), atol=1e-6)


@pytest.mark.parametrize("options", [{"heading": 0.4, "floor": 0.0}, {"heading": None, "floor": None}])
@pytest.mark.parametrize("names", [("right_hand", "left_foot", "right_foot"), ("pelvis",)])
def test_the_jacobian_is_that_of_central_differences(names: tuple[str, ...], options: dict[str, float]) -> None:
    points = {name: np.random.default_rng(3).normal(size=3) for name in names}
    search = Search(PRIOR, Objective(targets_of(points, options["heading"], options["floor"])))
    x = np.concatenate([np.random.default_rng(4).normal(size=32) * 0.4, [0.1, 0.8, -0.2, 0.7]])
    small = 1e-5
    columns = [(search.residuals(x + small * e)[0] - search.residuals(x - small * e)[0]) / small for e in np.eye(36)]
    expected = np.stack(columns, axis=1) / 2
    _, found = search.residuals(x)
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, atol=0.02 * np.abs(expected).max())
    np.testing.assert_allclose(found[:, 32:], expected[:, 32:], atol=0.01 * np.abs(expected).max())


def test_starts_are_put_where_their_joints_come_nearest() -> None:
    """Against a search over the yaw: nothing nearby is better than the fitted place."""
    candidates = Bodies(*PRIOR.starts)
    points = {"left_foot": (1.0, 0.0, 2.0), "right_foot": (1.2, 0.1, 1.9), "left_hand": (0.7, 1.1, 2.3)}
    targets = targets_of(points, None, None)
    yaw = fitted_yaw(candidates, targets)
    joints = list(targets.joints)

    def miss(turn: float) -> np.ndarray:
        placed = candidates.placed(fitted_root(candidates, targets, yaw + turn), yaw + turn)
        return np.square(placed[:, joints] - targets.points).sum(axis=(1, 2))

    best = miss(0.0)
    for turn in (-0.01, 0.01, 1.0, 2.0, 3.0):
        assert (miss(turn) >= best).all()


def test_the_best_start_has_the_pose_that_was_asked_for_if_there_is_one() -> None:
    latents, joints = PRIOR.starts
    points = {name: joints[7, i] for i, name in enumerate(SMPL24.names)}
    start = best_starts(PRIOR, targets_of(points, None, None), 1)[0]
    np.testing.assert_array_equal(start.latent, latents[7])
    np.testing.assert_allclose(start.root, 0, atol=1e-6)


def rows_of(positions: np.ndarray, latent: np.ndarray | None = None, **options: float | None) -> float:
    targets = targets_of({"head": positions[15]}, options.get("heading"), options.get("floor"))
    latents = np.zeros((1, 32)) if latent is None else latent[None]
    rows = Objective(targets).rows(latents, positions[None], np.zeros(1))
    return float(np.square(rows).sum())


def test_what_is_under_the_ground_or_far_from_the_prior_or_turned_away_costs() -> None:
    positions = positions_by_scipy(PRIOR.decode(np.zeros((1, 32)))[0], np.array([0, 0.955, 0]))
    standing = rows_of(positions, floor=0.0)
    assert rows_of(positions, floor=0.05) > standing + 5
    assert rows_of(positions, floor=0.0, heading=np.pi / 2) == pytest.approx(standing + (np.pi / 2 / 0.15) ** 2)
    one = np.eye(32)[0]
    assert rows_of(positions, 3 * one, floor=0.0) == pytest.approx(standing + 9)
    assert rows_of(positions, 10 * one, floor=0.0) > standing + 100 + 300  # longer than the bound


def test_a_heading_of_half_a_turn_costs_the_same_on_either_side() -> None:
    positions = positions_by_scipy(PRIOR.decode(np.zeros((1, 32)))[0], np.array([0, 0.955, 0]))
    left, right = (rows_of(positions, heading=turn) for turn in (np.pi - 0.01, 0.01 - np.pi))
    assert left == pytest.approx(right)
