"""Motions from joint positions: the inverse of forward kinematics, without twist."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24
from motionrt.motion.from_positions import from_positions

SEEDS = st.integers(0, 2**16)
LIMBS = [("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist")]
ENDS = [SMPL24.index(f"{side}_{limb[2]}") for side in ("left", "right") for limb in LIMBS]


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 30))
def test_forward_kinematics_of_the_answer_gives_the_positions(seed: int, frames: int) -> None:
    joints = random_motion(frames, seed=seed).positions()
    made = from_positions(joints, 30.0)
    assert (made.fps, made.frames) == (30.0, frames)
    np.testing.assert_allclose(made.positions(), joints, atol=1e-5)


@settings(max_examples=10, deadline=None)
@given(SEEDS)
def test_without_hands_all_other_joints_are_met_and_hands_follow(seed: int) -> None:
    joints = random_motion(10, seed=seed).positions()[:, :22]
    made = from_positions(joints, 20.0)
    np.testing.assert_allclose(made.positions()[:, :22], joints, atol=1e-5)
    np.testing.assert_allclose(made.rotations[:, 20:], np.broadcast_to(np.eye(3), (10, 4, 3, 3)), atol=1e-6)


@settings(max_examples=10, deadline=None)
@given(SEEDS)
def test_every_bone_turns_the_shortest_way_from_its_parent(seed: int) -> None:
    made = from_positions(random_motion(5, seed=seed).positions(), 20.0)
    for joint, child in ((1, 4), (5, 8), (13, 16), (16, 18), (19, 21), (20, 22), (12, 15)):
        vectors = Rotation.from_matrix(made.rotations[:, joint]).as_rotvec()
        np.testing.assert_allclose(vectors @ SMPL24.offsets[child], 0, atol=1e-5)


@settings(max_examples=15, deadline=None)
@given(SEEDS)
def test_noisy_positions_keep_bone_lengths_and_reach_wrists_and_ankles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    joints = walking(20, turn=0.2).positions()
    joints = joints + rng.normal(0, 0.004, joints.shape).astype(np.float32)
    made = from_positions(joints, 20.0).positions()
    bones = np.linalg.norm(made[:, 1:] - made[:, SMPL24.parents[1:]], axis=-1)
    np.testing.assert_allclose(
        bones, np.broadcast_to(np.linalg.norm(SMPL24.offsets[1:], axis=-1), bones.shape), atol=1e-5
    )
    reach = np.linalg.norm(made[:, ENDS] - joints[:, ENDS], axis=-1)
    starts = [SMPL24.index(f"{side}_{limb[0]}") for side in ("left", "right") for limb in LIMBS]
    wanted = np.linalg.norm(joints[:, ENDS] - made[:, starts], axis=-1)
    full = np.array([0.405 + np.hypot(0.410, 0.010), 0.52] * 2)
    assert (reach <= 0.003 + np.maximum(wanted - full, 0)).all()


def test_a_straight_leg_that_must_bend_bends_the_knee_forwards() -> None:
    joints = standing(1).positions().copy()
    joints[:, [4, 7, 10]] = joints[:, [1, 1, 1]] + np.array([[0, -0.37, 0], [0, -0.7, 0], [0, -0.76, 0.1]], np.float32)
    made = from_positions(joints, 20.0).positions()[0]
    np.testing.assert_allclose(made[7], joints[0, 7], atol=1e-3)
    assert made[4, 2] > made[1, 2] + 0.2


@pytest.mark.parametrize("shape", [(3, 21, 3), (0, 22, 3), (24, 3)])
def test_other_shapes_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match="joint positions must have the shape"):
        from_positions(np.zeros(shape), 20.0)


def test_joints_that_coincide_give_a_finite_motion() -> None:
    assert np.isfinite(from_positions(np.zeros((2, 22, 3)), 20.0).rotations).all()
