"""Motion as a value: forward kinematics, resampling, mirroring, canonical facing, grounding."""

from __future__ import annotations

import numpy as np
import pytest
from motions import random_motion, standing
from scipy.spatial.transform import Rotation, Slerp

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24, Motion, Skeleton
from motionrt.motion.transforms import facing, floor_height, heading, moved, turned


def test_rest_pose_is_a_t_pose_facing_plus_z_with_the_left_on_plus_x() -> None:
    rest, index = SMPL24.rest_positions, SMPL24.index
    assert rest[index("left_hand"), 0] > 0.7
    assert rest[index("right_hand"), 0] < -0.7
    assert rest[index("left_foot"), 2] > rest[index("left_ankle"), 2]
    np.testing.assert_allclose(rest[index("left_wrist"), 1], rest[index("left_shoulder"), 1], atol=1e-6)
    mirrored = rest[list(SMPL24.mirrored_joints)] * [-1, 1, 1]
    np.testing.assert_allclose(mirrored, rest, atol=1e-7)


def test_forward_kinematics_matches_scipy_joint_by_joint() -> None:
    motion = random_motion(4)
    positions = np.zeros((4, 24, 3))
    turns: list[Rotation] = []
    for joint, parent in enumerate(SMPL24.parents):
        local = Rotation.from_matrix(motion.rotations[:, joint])
        turns.append(local if parent < 0 else turns[parent] * local)
        step = motion.root if parent < 0 else positions[:, parent] + turns[parent].apply(SMPL24.offsets[joint])
        positions[:, joint] = step
    np.testing.assert_allclose(motion.positions(), positions, atol=1e-5)
    np.testing.assert_allclose(motion.global_rotations()[:, -1], turns[-1].as_matrix(), atol=1e-5)


def test_resampling_slerps_rotations_and_interpolates_the_root_linearly() -> None:
    motion = random_motion(31, fps=60)
    resampled = motion.resample(20)
    assert (resampled.frames, resampled.fps) == (11, 20)
    np.testing.assert_allclose(resampled.root, motion.root[::3], atol=1e-6)
    up = motion.resample(100)
    times, key_times = np.arange(up.frames) / 100, np.arange(31) / 60
    expected = Slerp(key_times, Rotation.from_matrix(motion.rotations[:, 5]))(times).as_matrix()
    np.testing.assert_allclose(up.rotations[:, 5], expected, atol=1e-4)
    np.testing.assert_allclose(up.root[:, 1], np.interp(times, key_times, motion.root[:, 1]), atol=1e-5)


@pytest.mark.parametrize(("frames", "fps", "expected"), [(1, 60, 1), (2, 60, 1), (4, 60, 2), (121, 120, 21)])
def test_resampling_never_invents_time_beyond_the_last_frame(frames: int, fps: float, expected: int) -> None:
    assert random_motion(frames, fps=fps).resample(20).frames == expected


def test_mirroring_exchanges_left_and_right_positions() -> None:
    motion = random_motion(6)
    expected = motion.positions()[:, list(SMPL24.mirrored_joints)] * [-1, 1, 1]
    np.testing.assert_allclose(motion.mirror().positions(), expected, atol=1e-5)
    np.testing.assert_allclose(motion.mirror().mirror().rotations, motion.rotations, atol=1e-6)


def test_canonical_motion_starts_over_the_origin_facing_plus_z_and_keeps_its_shape() -> None:
    motion = turned(random_motion(8, root=(3, 1, -2)), 2.0)
    canonical = motion.canonical()
    np.testing.assert_allclose(facing(canonical)[0], [0, 0, 1], atol=1e-5)
    np.testing.assert_allclose(canonical.root[0, [0, 2]], 0, atol=1e-5)
    np.testing.assert_allclose(canonical.root[:, 1], motion.root[:, 1], atol=1e-6)
    distances = [np.linalg.norm(np.diff(m.positions(), axis=0), axis=-1) for m in (motion, canonical)]
    np.testing.assert_allclose(*distances, atol=1e-5)


def test_heading_follows_a_turn_about_the_vertical() -> None:
    assert heading(turned(standing(), 0.7))[0] == pytest.approx(0.7, abs=1e-5)


def test_grounding_puts_the_lower_toe_on_the_floor() -> None:
    lifted = moved(standing(), np.array([0, 2, 0]))
    assert floor_height(lifted) > 1.5
    assert floor_height(lifted.grounded()) == pytest.approx(0, abs=1e-5)


def test_between_takes_seconds_and_always_keeps_a_frame() -> None:
    motion = random_motion(60, fps=30)
    assert motion.between(0.5, 1.5).frames == 30
    np.testing.assert_array_equal(motion.between(0.5, 1.5).root[0], motion.root[15])
    assert motion.between(9, 12).frames == 1


def test_a_motion_cannot_be_changed_through_its_arrays_or_the_callers() -> None:
    rotations = np.tile(np.eye(3, dtype=np.float32), (2, 24, 1, 1))
    motion = Motion(rotations, np.zeros((2, 3), np.float32), 30)
    rotations[:] = 7
    assert motion.rotations.max() == 1
    with pytest.raises(ValueError, match="read-only"):
        motion.root[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        motion.positions()[0] = 1


@pytest.mark.parametrize(
    ("rotations", "root", "fps", "message"),
    [
        (np.zeros((0, 24, 3, 3)), np.zeros((0, 3)), 30, "rotations must have the shape"),
        (np.zeros((2, 23, 3, 3)), np.zeros((2, 3)), 30, "rotations must have the shape"),
        (np.zeros((2, 24, 3, 3)), np.zeros((2, 2)), 30, "root must have the shape"),
        (np.zeros((2, 24, 3, 3)), np.zeros((3, 3)), 30, "2 frames but root has 3"),
        (np.zeros((2, 24, 3, 3)), np.array([[0, 0, 0], [0, np.nan, 0]]), 30, "root holds a number .* frame 1"),
        (np.zeros((2, 24, 3, 3)), np.zeros((2, 3)), 0, "fps must be a positive number"),
        (np.zeros((2, 24, 3, 3)), np.zeros((2, 3)), float("nan"), "fps must be a positive number"),
    ],
)
def test_wrong_arrays_are_refused_in_words(rotations: np.ndarray, root: np.ndarray, fps: float, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        Motion(rotations, root, fps)


def test_indexing_with_a_number_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="slice"):
        random_motion(3)[1]  # type: ignore[index]


def test_skeletons_compare_by_value_and_refuse_a_child_before_its_parent() -> None:
    assert Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets) == SMPL24
    with pytest.raises(InvalidInputError, match="before its children"):
        Skeleton(("a", "b", "c"), (-1, 2, 0), np.zeros((3, 3)))
    with pytest.raises(InvalidInputError, match="no joint 'tail'"):
        SMPL24.index("tail")
