"""Poses from keypoints: they are met, everywhere and mirrored, and what the keypoints leave open is plausible."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from toy_prior import ToyPrior, mirrored_latent, positions_by_scipy

from motionrt.locomotion.posing import solve_pose
from motionrt.metrics import penetration_depths
from motionrt.motion import SMPL24

HAND_AND_FEET = ("right_hand", "left_foot", "right_foot")
PELVIS_AND_FEET = ("pelvis", "left_foot", "right_foot")
PRIOR = ToyPrior()


def pose(seed: int, yaw: float = 0.0) -> np.ndarray:
    """Joint positions (24, 3) of a random toy pose whose lower toe is on the floor."""
    latent = np.random.default_rng(seed).normal(size=(1, 32)) * 0.5
    rotations = PRIOR.decode(latent)[0]
    rotations[0] = Rotation.from_euler("Y", yaw).as_matrix() @ rotations[0]
    positions = positions_by_scipy(rotations, np.zeros(3))
    return positions - [0.0, positions[[10, 11], 1].min(), 0.0]


def keypoints(positions: np.ndarray, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    return {name: positions[SMPL24.index(name)] for name in names}


@pytest.mark.parametrize("names", [HAND_AND_FEET, PELVIS_AND_FEET, ("left_hand", "right_hand", "head", "pelvis")])
@pytest.mark.parametrize("seed", range(4))
def test_keypoints_of_a_pose_are_met_within_a_centimetre(names: tuple[str, ...], seed: int) -> None:
    solution = solve_pose(keypoints(pose(seed, yaw=seed * 1.5), names), PRIOR)
    assert solution.mean_error_cm < 1.0
    assert solution.motion.frames == 1


def test_the_errors_are_the_distances_of_the_posed_joints() -> None:
    wanted = keypoints(pose(1), HAND_AND_FEET)
    solution = solve_pose(wanted, PRIOR)
    reached = positions_by_scipy(solution.motion.rotations[0], solution.motion.root[0])
    for name, point in wanted.items():
        distance = 100 * np.linalg.norm(reached[SMPL24.index(name)] - point)
        assert solution.errors_cm[name] == pytest.approx(distance, abs=1e-3)
    assert solution.max_error_cm == max(solution.errors_cm.values())
    assert solution.mean_error_cm == pytest.approx(np.mean(list(solution.errors_cm.values())))


def test_all_24_joints_give_the_pose_back() -> None:
    wanted = pose(2, yaw=2.0)
    solution = solve_pose(keypoints(wanted, SMPL24.names), PRIOR)
    assert np.linalg.norm(solution.motion.positions()[0] - wanted, axis=1).max() < 0.01


@pytest.mark.parametrize("seed", range(3))
def test_mirrored_keypoints_give_the_mirrored_pose(seed: int) -> None:
    wanted = keypoints(pose(seed), ("left_hand", "left_foot", "right_foot"))
    swap = {name: SMPL24.names[SMPL24.mirrored_joints[SMPL24.index(name)]] for name in wanted}
    reflected = {swap[name]: point * [-1, 1, 1] for name, point in wanted.items()}
    one, other = solve_pose(wanted, PRIOR), solve_pose(reflected, PRIOR)
    for name in wanted:
        assert one.errors_cm[name] == pytest.approx(other.errors_cm[swap[name]], abs=0.05)
    np.testing.assert_allclose(one.motion.mirror().positions(), other.motion.positions(), atol=0.01)
    np.testing.assert_allclose(mirrored_latent(one.latent), other.latent, atol=0.05)


def test_keypoints_elsewhere_and_turned_give_the_same_pose_there() -> None:
    wanted = keypoints(pose(3), HAND_AND_FEET)
    turn, move = Rotation.from_euler("Y", 2.5), np.array([10.0, 0.0, -7.0])
    here = solve_pose(wanted, PRIOR)
    there = solve_pose({name: turn.apply(point) + move for name, point in wanted.items()}, PRIOR)
    expected = turn.apply(here.motion.positions()[0]) + move
    np.testing.assert_allclose(there.motion.positions()[0], expected, atol=0.01)


def test_the_ground_may_be_at_any_height() -> None:
    wanted = keypoints(pose(3), HAND_AND_FEET)
    upstairs = {name: point + np.array([0, 4.2, 0]) for name, point in wanted.items()}
    here, there = solve_pose(wanted, PRIOR), solve_pose(upstairs, PRIOR, floor=4.2)
    np.testing.assert_allclose(there.motion.positions() - [0, 4.2, 0], here.motion.positions(), atol=0.01)


@pytest.mark.parametrize("heading", [-2.0, 0.0, 0.5, 3.1])
def test_the_body_faces_the_heading_that_was_asked_for(heading: float) -> None:
    forward = np.array([np.sin(heading), 0, np.cos(heading)])
    solution = solve_pose({"right_hand": 0.4 * forward + [0, 1.2, 0]}, PRIOR, heading=heading)
    away = np.rad2deg(solution.heading - heading)
    assert abs((away + 180) % 360 - 180) < 10
    pelvis = solution.motion.rotations[0, 0] @ [0, 0, 1]
    assert pelvis @ forward > np.cos(np.deg2rad(15)) * np.linalg.norm(pelvis[[0, 2]])


@pytest.mark.parametrize("yaw", [0.0, 1.0, 2.0, -2.0])
def test_without_a_heading_pelvis_and_feet_say_where_the_body_faces(yaw: float) -> None:
    turn = Rotation.from_euler("Y", yaw)
    local = {"pelvis": [0, 0.93, -0.1], "left_foot": [0.12, 0, 0.03], "right_foot": [-0.12, 0, 0.03]}
    solution = solve_pose({name: turn.apply(point) for name, point in local.items()}, PRIOR)
    assert abs((np.rad2deg(solution.heading - yaw) + 180) % 360 - 180) < 25


def test_one_keypoint_alone_is_met_by_a_standing_body_that_faces_ahead() -> None:
    solution = solve_pose({"left_hand": (2.0, 1.2, 5.0)}, PRIOR)
    positions = solution.motion.positions()[0]
    assert solution.max_error_cm < 1.0
    assert np.abs(positions[[10, 11], 1]).max() < 0.04  # toes
    assert positions[15, 1] > 1.2  # head
    assert abs(np.rad2deg(solution.heading)) < 60


def test_a_low_pelvis_leaves_the_feet_on_the_ground() -> None:
    solution = solve_pose({"pelvis": (0, 0.55, 0)}, PRIOR)
    assert np.abs(solution.motion.positions()[0, [10, 11], 1]).max() < 0.06


def test_without_a_floor_feet_may_hang() -> None:
    solution = solve_pose({"pelvis": (0, 3.0, 0)}, PRIOR, floor=None)
    assert solution.max_error_cm < 0.1
    assert solution.motion.positions()[0, :, 1].min() > 1.5


def test_the_body_stands_above_its_feet_where_the_keypoints_leave_it_open() -> None:
    feet = {"left_foot": (0.1, 0, 0.13), "right_foot": (-0.1, 0, 0.13)}
    positions = solve_pose({**feet, "right_hand": (-0.2, 1.0, 0.45)}, PRIOR, heading=0.0).motion.positions()[0]
    assert np.linalg.norm((positions[0] - positions[[7, 8]].mean(axis=0))[[0, 2]]) < 0.25


def test_a_solution_is_repeated_exactly() -> None:
    wanted = keypoints(pose(0), HAND_AND_FEET)
    one, other = solve_pose(wanted, PRIOR), solve_pose(wanted, PRIOR)
    np.testing.assert_array_equal(one.motion.rotations, other.motion.rotations)
    assert one.iterations == other.iterations > 1


def test_limbs_keep_out_of_surfaces_and_keypoints_are_met_all_the_same() -> None:
    wanted = keypoints(pose(4), PELVIS_AND_FEET)
    free = solve_pose(wanted, PRIOR, heading=0.0)
    hand = free.motion.positions()[0, SMPL24.index("left_wrist")].astype(float)
    across, up = np.meshgrid(np.arange(-0.3, 0.31, 0.05), np.arange(-0.3, 0.31, 0.05))
    wall = np.stack([np.full(across.size, hand[0] + 0.01), hand[1] + up.ravel(), hand[2] + across.ravel()], axis=1)
    clear = solve_pose(wanted, PRIOR, heading=0.0, surfaces=wall)
    assert penetration_depths(free.motion.positions(), wall)[0] > 1.0
    assert penetration_depths(clear.motion.positions(), wall)[0] < 0.5
    assert clear.mean_error_cm < 1.0


def test_surfaces_out_of_reach_change_nothing() -> None:
    wanted = keypoints(pose(4), PELVIS_AND_FEET)
    far = np.full((5, 3), 9.0)
    one, other = solve_pose(wanted, PRIOR), solve_pose(wanted, PRIOR, surfaces=far)
    np.testing.assert_array_equal(one.motion.rotations, other.motion.rotations)
