"""Two-bone inverse kinematics: it reaches, keeps the bones, keeps the plane, and never snaps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion
from scipy.spatial.transform import Rotation

from motionrt.motion.feet.two_bone import LEG_JOINTS, bend_legs, two_bone
from motionrt.motion.kinematics import fk
from motionrt.motion.skeleton import SMPL24

THIGH, SHIN = 0.4, 0.35
FULL = THIGH + SHIN
FORWARD = np.array([0.0, 0.0, 1.0])


def bent_leg(bend: float) -> np.ndarray:
    """Hip at the origin, knee towards +Z, the ankle straight below the hip; ``bend`` in radians at the hip."""
    knee = THIGH * np.array([0, -np.cos(bend), np.sin(bend)])
    drop = np.sqrt(SHIN**2 - knee[2] ** 2)
    return np.stack([np.zeros(3), knee, [0, knee[1] - drop, 0]])


def rigid(chain: np.ndarray, moved: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Where the turns (from identity) put the bones of ``chain``."""
    knee = moved[..., 0, :] + (turns[..., 0, :, :] @ (chain[..., 1, :] - chain[..., 0, :])[..., None])[..., 0]
    ankle = knee + (turns[..., 1, :, :] @ (chain[..., 2, :] - chain[..., 1, :])[..., None])[..., 0]
    return np.stack([moved[..., 0, :], knee, ankle], axis=-2)


directions = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


@settings(max_examples=150, deadline=None)
@given(directions, st.floats(0.1, 0.985), st.floats(0.0, 1.0), st.integers(0, 1000))
def test_a_reachable_target_is_reached_with_bones_of_the_same_length(
    way: tuple[float, float, float], share: float, bend: float, seed: int
) -> None:
    chain = bent_leg(bend) @ Rotation.random(random_state=seed).as_matrix().T
    target = FULL * share * np.array(way) / np.linalg.norm(way)
    moved, turns = two_bone(chain, np.tile(np.eye(3), (2, 1, 1)), target, FORWARD)
    np.testing.assert_allclose(moved[2], target, atol=1e-4)
    np.testing.assert_allclose(np.linalg.norm(np.diff(moved, axis=0), axis=1), [THIGH, SHIN], atol=1e-6)
    np.testing.assert_allclose(rigid(chain, moved, turns), moved, atol=1e-6)
    np.testing.assert_allclose(np.linalg.det(turns), 1, atol=1e-9)


@pytest.mark.parametrize("bend", [0.0, 0.01, 0.05, 0.5, 1.0])
def test_a_target_at_the_end_joint_changes_nothing(bend: float) -> None:
    chain = bent_leg(bend)
    moved, turns = two_bone(chain, np.tile(np.eye(3), (2, 1, 1)), chain[2], FORWARD)
    np.testing.assert_allclose(moved, chain, atol=1e-4 if bend else 3e-3)  # a straight limb ends 1e-5 short of straight
    np.testing.assert_allclose(turns, np.tile(np.eye(3), (2, 1, 1)), atol=1e-3 if bend else 1e-2)


def test_a_bent_limb_stays_in_its_plane_whatever_the_pole_says() -> None:
    chain = bent_leg(0.5)
    target = chain[2] * 0.8
    for pole in (FORWARD, -FORWARD, np.array([1.0, 0, 0])):
        moved, _ = two_bone(chain, np.tile(np.eye(3), (2, 1, 1)), target, pole)
        assert abs(moved[1, 0]) < 1e-8
        assert moved[1, 2] > chain[1, 2]


def test_a_straight_limb_bends_towards_the_pole() -> None:
    chain = np.array([[0, 0, 0], [0, -THIGH, 0], [0, -FULL, 0]])
    moved, _ = two_bone(chain, np.tile(np.eye(3), (2, 1, 1)), np.array([0, -0.6, 0]), FORWARD)
    assert moved[1, 2] > 0.1
    assert abs(moved[1, 0]) < 1e-8
    backward = chain + np.array([[0, 0, 0], [0, 0, -0.002], [0, 0, 0]])  # a knee bent the wrong way by 2 mm
    moved, _ = two_bone(backward, np.tile(np.eye(3), (2, 1, 1)), np.array([0, -0.6, 0]), FORWARD)
    assert moved[1, 2] > 0.1


def test_a_target_out_of_reach_is_approached_softly_and_in_order() -> None:
    reach = np.linspace(0.9, 1.3, 400) * FULL
    target = np.stack([0 * reach, -reach, 0 * reach], axis=-1)
    moved, _ = two_bone(np.tile(bent_leg(0.5), (400, 1, 1)), np.tile(np.eye(3), (400, 2, 1, 1)), target, FORWARD)
    got = -moved[:, 2, 1]
    assert (np.diff(got) >= 0).all()
    assert got.max() < FULL
    assert np.abs(np.diff(moved[:, 1], axis=0)).max() < 0.02  # the knee never jumps, steps of the target are 0.75 mm


def test_legs_move_the_feet_by_the_offsets_and_keep_all_else() -> None:
    motion = random_motion(20, seed=3)
    offset = np.random.default_rng(0).normal(0, 0.01, (20, 2, 3))
    local = bend_legs(motion.rotations, motion.positions(), motion.global_rotations(), offset, soft=1e-4)
    positions, turned = fk(local, motion.root, SMPL24.offsets, SMPL24.parents)
    ankles = [leg[2] for leg in LEG_JOINTS]
    toes = [leg[3] for leg in LEG_JOINTS]
    reachable = np.linalg.norm(motion.positions()[:, [4, 5]] - motion.positions()[:, [1, 2]], axis=-1) < 1
    assert reachable.all()
    for joints in (ankles, toes):
        miss = positions[:, joints] - motion.positions()[:, joints] - offset
        assert np.median(np.abs(miss)) < 1e-5
    np.testing.assert_allclose(turned[:, ankles], motion.global_rotations()[:, ankles], atol=1e-5)
    untouched = [j for j in range(24) if j not in {joint for leg in LEG_JOINTS for joint in leg[:3]}]
    np.testing.assert_array_equal(local[:, untouched], motion.rotations[:, untouched])
