"""The three feature vectors: exact inverses, invariances and hand-worked entries."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion, standing, walking

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import ccf219, guo263, sinc135
from motionrt.motion.transforms import moved, turned

SEEDS = st.integers(0, 2**16)


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 30))
def test_sinc135_round_trips_22_joints_and_the_root(seed: int, frames: int) -> None:
    motion = random_motion(frames, fps=30, seed=seed)
    back = sinc135.decode(sinc135.encode(motion))
    np.testing.assert_allclose(back.rotations[:, :22], motion.rotations[:, :22], atol=1e-5)
    np.testing.assert_allclose(back.root, motion.root, atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 30))
def test_ccf219_round_trips_all_joints_and_the_root(seed: int, frames: int) -> None:
    motion = random_motion(frames, fps=30, seed=seed)
    back = ccf219.decode(ccf219.encode(motion))
    np.testing.assert_allclose(back.rotations, motion.rotations, atol=1e-5)
    np.testing.assert_allclose(back.root, motion.root, atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 60))
def test_guo263_recovers_joint_positions_to_a_millimetre_and_rotations(seed: int, frames: int) -> None:
    motion = random_motion(frames, seed=seed).canonical()
    features = guo263.encode(motion)
    np.testing.assert_allclose(guo263.positions(features), motion.positions()[:, :22], atol=1e-3)
    back = guo263.decode(features)
    np.testing.assert_allclose(back.positions()[:, :22], motion.positions()[:, :22], atol=1e-3)
    np.testing.assert_allclose(back.rotations[:, :20], motion.rotations[:, :20], atol=1e-4)


def test_guo263_holds_positions_of_a_long_walk_without_drift() -> None:
    motion = walking(2000, turn=0.3).canonical()
    np.testing.assert_allclose(guo263.positions(guo263.encode(motion)), motion.positions()[:, :22], atol=1e-3)


def test_guo263_does_not_see_where_the_motion_starts_or_faces() -> None:
    motion = random_motion(20)
    elsewhere = moved(turned(motion, 1.3), np.array([4, 0, -9]))
    np.testing.assert_allclose(guo263.encode(elsewhere), guo263.encode(motion), atol=1e-4)


def test_guo263_of_a_standing_pose_is_still_with_all_contacts() -> None:
    row = guo263.encode(standing(5))[2]
    assert row[guo263.YAW_STEP] == 0
    np.testing.assert_array_equal(row[guo263.PLANAR], 0)
    np.testing.assert_array_equal(row[guo263.VELOCITIES], 0)
    np.testing.assert_array_equal(row[guo263.CONTACTS], 1)
    np.testing.assert_allclose(row[guo263.POSITIONS][:3], [0.085, standing().root[0, 1] - 0.075, 0], atol=1e-6)


def test_guo263_of_a_straight_turning_walk_has_its_speed_and_half_its_yaw_step() -> None:
    features = guo263.encode(walking(40, speed=1.2, turn=0.5))
    np.testing.assert_allclose(features[:, guo263.YAW_STEP], 0.5 / 20 / 2, atol=1e-4)
    np.testing.assert_allclose(features[5, guo263.PLANAR], [0, 1.2 / 20], atol=2e-3)


def test_guo263_yaw_step_stays_small_when_the_heading_passes_pi() -> None:
    steps = guo263.encode(walking(200, turn=1.0))[:, guo263.YAW_STEP]
    np.testing.assert_allclose(steps, 1.0 / 20 / 2, atol=1e-3)


@pytest.mark.parametrize(("module", "width"), [(sinc135, 135), (ccf219, 219), (guo263, 263)])
def test_feature_widths_and_dtype_are_as_named(module: ModuleType, width: int) -> None:
    features = module.encode(random_motion(7))
    assert (features.shape, features.dtype, module.WIDTH) == ((7, width), np.float32, width)


@pytest.mark.parametrize("module", [sinc135, ccf219, guo263])
@pytest.mark.parametrize("shape", [(5, 12), (0, 135), (135,)])
def test_features_of_another_shape_are_refused(module: ModuleType, shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match="features must have the shape"):
        module.decode(np.zeros(shape, np.float32))


def test_decoding_projects_predicted_matrices_to_rotations() -> None:
    noisy = ccf219.encode(random_motion(5)) + np.random.default_rng(0).normal(0, 0.05, (5, 219)).astype(np.float32)
    decoded: Motion = ccf219.decode(noisy)
    np.testing.assert_allclose(np.linalg.det(decoded.rotations), 1, atol=1e-5)


@settings(max_examples=10, deadline=None)
@given(SEEDS)
def test_mirrored_guo263_features_are_the_features_of_the_mirrored_motion(seed: int) -> None:
    motion = random_motion(20, seed=seed)
    mirrored = guo263.mirror(guo263.encode(motion))
    np.testing.assert_allclose(mirrored, guo263.encode(motion.mirror()), atol=1e-5)
    np.testing.assert_array_equal(guo263.mirror(mirrored), guo263.encode(motion))
