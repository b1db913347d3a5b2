"""``guo263`` against the published formulas (a slow reference of its own), and what follows from them."""

from __future__ import annotations

from pathlib import Path

import guo_reference
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.formats import load_motion
from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import guo263
from motionrt.motion.features.guo_file import GROUPS
from motionrt.motion.transforms import moved, turned

SEEDS = st.integers(0, 2**16)
CMU = Path(__file__).parents[4] / "shared" / "data" / "mocap" / "cmu"


def other_proportions(seed: int, frames: int) -> np.ndarray:
    """Joints ``(F, 22, 3)`` of a random motion on a skeleton with randomly longer and shorter bones."""
    motion = random_motion(frames, seed=seed)
    factors = np.random.default_rng(seed).uniform(0.7, 1.4, 22)
    joints = motion.positions()[:, :22].astype(float)
    out = joints.copy()
    for joint in range(1, 22):
        parent = SMPL24.parents[joint]
        out[:, joint] = out[:, parent] + factors[joint] * (joints[:, joint] - joints[:, parent])
    return out


@settings(max_examples=5, deadline=None)
@given(SEEDS, st.integers(2, 12))
def test_rows_are_those_of_the_published_formulas_whatever_the_proportions(seed: int, frames: int) -> None:
    joints = other_proportions(seed, frames)
    expected, _ = guo_reference.process(joints)
    np.testing.assert_allclose(guo263.encode_positions(joints)[:-1], expected, atol=2e-6)


def test_headings_are_smoothed_as_published_over_a_long_turning_walk() -> None:
    motion = walking(60, turn=0.4)
    expected, _ = guo_reference.process(motion.positions()[:, :22])
    np.testing.assert_allclose(guo263.encode(motion)[:-1], expected, atol=2e-6)


@settings(max_examples=5, deadline=None)
@given(SEEDS, st.integers(2, 12))
def test_the_published_recovery_gives_the_joints_on_the_published_skeleton(seed: int, frames: int) -> None:
    joints = other_proportions(seed, frames)
    _, placed = guo_reference.process(joints)
    features = guo263.encode_positions(joints)
    np.testing.assert_allclose(guo_reference.recover(features.astype(float)), placed, atol=1e-5)
    np.testing.assert_allclose(guo263.positions(features), placed, atol=1e-5)


def test_paths_do_not_bend_where_the_heading_passes_half_a_turn() -> None:
    motion = walking(90, turn=1.4)
    features = guo263.encode(motion)
    _, placed = guo_reference.process(motion.positions()[:, :22])
    np.testing.assert_allclose(guo263.positions(features), placed, atol=1e-5)
    np.testing.assert_allclose(np.median(features[:, guo263.YAW_STEP]), -1.4 / 20 / 2, rtol=0.05)


def test_the_last_row_is_the_last_pose_with_the_steps_of_the_row_before() -> None:
    motion = random_motion(9, seed=3)
    features = guo263.encode(motion)
    steps = [*range(3), *range(193, 263)]
    np.testing.assert_array_equal(features[-1, steps], features[-2, steps])
    _, placed = guo_reference.process(motion.positions()[:, :22])
    np.testing.assert_allclose(guo263.positions(features)[-1], placed[-1], atol=1e-5)


def twisted(motion: Motion, seed: int) -> Motion:
    """The same joint positions: every joint with one child twisted about the bone to it, and leaves at random."""
    rng = np.random.default_rng(seed)
    globally = motion.global_rotations().astype(float).copy()
    for joint in range(1, len(SMPL24)):
        children = [child for child, parent in enumerate(SMPL24.parents) if parent == joint]
        if len(children) <= 1:
            axis = SMPL24.offsets[children[0]] if children else rng.normal(size=3)
            angle = rng.uniform(-np.pi, np.pi)
            globally[:, joint] = (
                globally[:, joint] @ Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()
            )
    local = globally.copy()
    for joint in range(1, len(SMPL24)):
        local[:, joint] = np.swapaxes(globally[:, SMPL24.parents[joint]], -1, -2) @ globally[:, joint]
    return Motion(local.astype(np.float32), motion.root, motion.fps)


@settings(max_examples=10, deadline=None)
@given(SEEDS)
def test_twist_of_the_bones_does_not_enter(seed: int) -> None:
    motion = random_motion(15, seed=seed)
    other = twisted(motion, seed + 1)
    assert np.abs(other.rotations[:, 4] - motion.rotations[:, 4]).max() > 0.1
    np.testing.assert_allclose(guo263.encode(other), guo263.encode(motion), atol=1e-4)


def test_features_do_not_see_where_the_motion_starts_or_faces_nor_its_floor() -> None:
    motion = random_motion(20)
    elsewhere = moved(turned(motion, 1.3), np.array([4, 0.7, -9]))
    np.testing.assert_allclose(guo263.encode(elsewhere), guo263.encode(motion), atol=1e-4)


@settings(max_examples=10, deadline=None)
@given(SEEDS, st.integers(1, 40))
def test_mirrored_features_are_the_features_of_the_mirrored_motion(seed: int, frames: int) -> None:
    motion = random_motion(frames, seed=seed)
    features = guo263.encode(motion)
    mirrored = guo263.mirror(features)
    np.testing.assert_allclose(mirrored, guo263.encode(motion.mirror()), atol=1e-4)
    np.testing.assert_allclose(guo263.mirror(mirrored), features, atol=1e-4)


@settings(max_examples=10, deadline=None)
@given(SEEDS, st.integers(0, 30))
def test_a_part_has_the_features_of_the_cut_motion(seed: int, start: int) -> None:
    motion = random_motion(40, seed=seed)
    found = guo263.part(guo263.encode(motion), start, start + 10)
    np.testing.assert_allclose(found, guo263.encode(motion[start : start + 10]), atol=1e-4)


def test_mirroring_keeps_half_precision() -> None:
    features = guo263.encode(walking(50, turn=0.3))
    mirrored = guo263.mirror(features.astype(np.float16))
    assert mirrored.dtype == np.float16
    np.testing.assert_allclose(mirrored[:, :193], guo263.mirror(features)[:, :193], atol=5e-3)


@settings(max_examples=10, deadline=None)
@given(SEEDS, st.integers(1, 40))
def test_decoding_gives_back_the_motion_up_to_its_place_and_heading(seed: int, frames: int) -> None:
    motion = random_motion(frames, seed=seed)
    features = guo263.encode(motion)
    back = guo263.decode(features)
    ours, theirs = (m.positions()[:, :22].reshape(-1, 3).astype(float) for m in (back, motion))
    turn, _ = Rotation.align_vectors(theirs - theirs[0], ours - ours[0])
    np.testing.assert_allclose(turn.apply(ours - ours[0]), theirs - theirs[0], atol=1e-3)
    np.testing.assert_allclose(turn.as_matrix()[:, 1], [0, 1, 0], atol=1e-4)
    np.testing.assert_allclose(guo263.encode(back), features, atol=1e-4)
    assert back.positions()[:, :22, 1].min() == pytest.approx(0, abs=1e-5)


def test_a_standing_pose_is_still_with_all_contacts() -> None:
    row = guo263.encode(standing(5))[2]
    np.testing.assert_array_equal(row[:3], 0)
    np.testing.assert_array_equal(row[guo263.VELOCITIES], 0)
    np.testing.assert_array_equal(row[guo263.CONTACTS], 1)
    hip = np.array([0.085, -0.075]) * 0.10307395 / np.hypot(0.085, 0.075)
    np.testing.assert_allclose(row[guo263.POSITIONS][:3], [hip[0], row[guo263.HEIGHT] + hip[1], 0], atol=1e-4)
    tilt = np.arctan2(0.075, 0.085)  # the hip's bone from +X down; the thigh hangs as at rest
    knee = [np.cos(tilt), np.sin(tilt), 0, -np.sin(tilt), np.cos(tilt), 0]
    np.testing.assert_allclose(row[guo263.ROTATIONS].reshape(21, 6)[3], knee, atol=2e-3)


def test_one_frame_has_no_steps() -> None:
    np.testing.assert_array_equal(guo263.encode(random_motion(1))[0, [0, 1, 2, *range(193, 259)]], 0)


def test_a_bone_opposite_to_its_rest_or_of_no_length_has_a_rotation() -> None:
    joints = standing(3).positions()[:, :22].copy()
    joints[:, 20] = joints[:, 18] + [0, 0.25, 0]  # the left forearm straight up; it hangs down at rest
    joints[:, 15] = joints[:, 12]
    features = guo263.encode_positions(joints)
    assert np.isfinite(features).all()
    sixd = features[:, guo263.ROTATIONS].reshape(-1, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(sixd, axis=-1), 1, atol=1e-6)


@pytest.mark.parametrize("shape", [(3, 21, 3), (0, 22, 3), (22, 3)])
def test_joints_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match="joint positions must have the shape"):
        guo263.encode_positions(np.zeros(shape))


def test_joints_that_are_not_finite_are_refused() -> None:
    joints = standing(3).positions().copy()
    joints[1, 4, 2] = np.nan
    with pytest.raises(InvalidInputError, match="not finite"):
        guo263.encode_positions(joints)


@pytest.mark.parametrize("trial", ["01_02", "02_01", "05_18", "09_03", "49_21"])
def test_the_same_recording_through_bvh_and_amc_has_the_same_features(trial: str) -> None:
    pair = CMU / "bvh" / f"{trial}.bvh", CMU / "pairs" / f"{trial}.amc"
    if not all(path.exists() for path in pair):
        pytest.skip(f"the shared recordings are not here: {pair[1]}")
    bvh, amc = (guo263.encode(Motion(m.rotations, m.root, 60).resample(20)) for m in map(load_motion, pair))
    frames = min(len(bvh), len(amc))
    for columns in GROUPS.values():
        apart = np.abs(bvh[:frames, columns] - amc[:frames, columns])
        assert apart.mean() <= 0.03 * max(float(bvh[:, columns].std(axis=0).mean()), 1e-3)
