"""Telling a calibration pose in front of the motion from the motion itself."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.spatial.transform import Rotation

from motionrt.formats import drop_leading_tpose
from motionrt.rigs.clip import RigClip

JOINTS = 10


def clip_of(angles: np.ndarray, fps: float = 60) -> RigClip:
    """A chain of joints and an end site; ``angles (F, J)`` in degrees about X."""
    frames = len(angles)
    turns = Rotation.from_euler("x", angles.reshape(-1, 1), degrees=True).as_matrix()
    still = np.tile(np.eye(3), (frames, 1, 1, 1))
    rotations = np.concatenate([turns.reshape(frames, -1, 3, 3), still], axis=1).astype(np.float32)
    names = (*(f"joint{j}" for j in range(JOINTS)), "joint9_end")
    offsets = np.tile(np.array([0, 1, 0], np.float32), (JOINTS + 1, 1))
    translations = np.tile(offsets, (frames, 1, 1))
    return RigClip(names, tuple(range(-1, JOINTS)), offsets, rotations, translations, fps)


def walk(frames: int = 40) -> np.ndarray:
    """Smooth motion of all joints about a bent pose, degrees."""
    time = np.arange(frames)[:, None] / 60
    return 35 + np.arange(JOINTS) + 15 * np.sin(2 * np.pi * time + np.arange(JOINTS))


def t_pose(frames: int = 1) -> np.ndarray:
    pose = np.zeros((frames, JOINTS))
    pose[:, :2] = [21, -21]  # calibration poses keep a few constant angles
    return pose


def test_leading_pose_is_dropped_and_handed_out() -> None:
    clip = clip_of(np.concatenate([t_pose(), walk()]))
    motion, reference = drop_leading_tpose(clip)
    assert_array_equal(motion.rotations, clip.rotations[1:])
    assert_array_equal(motion.translations, clip.translations[1:])
    assert reference is not None
    assert_array_equal(reference, clip.rotations[0])


@pytest.mark.parametrize("blanks", [1, 2])
def test_blank_frames_behind_the_pose_go_too(blanks: int) -> None:
    clip = clip_of(np.concatenate([t_pose(), np.zeros((blanks, JOINTS)), walk()]))
    assert drop_leading_tpose(clip)[0].frames == 40


def test_frames_blended_between_pose_and_motion_go_too() -> None:
    motion = walk()
    blended = t_pose() + (motion[0] - t_pose()) * np.array([[0.2], [0.7]])
    assert drop_leading_tpose(clip_of(np.concatenate([t_pose(), blended, motion])))[0].frames == 40


def test_motion_that_begins_anywhere_else_is_kept() -> None:
    clip = clip_of(walk())
    motion, reference = drop_leading_tpose(clip)
    assert motion is clip
    assert reference is None


def test_motion_that_leaves_a_t_pose_smoothly_is_kept() -> None:
    ease = np.sin(np.linspace(0, np.pi / 2, 40))[:, None]
    clip = clip_of(t_pose() + (walk() - t_pose()) * ease)
    assert drop_leading_tpose(clip)[0].frames == 40


def test_a_sudden_glitch_that_is_no_rest_pose_is_kept() -> None:
    glitch = np.full((1, JOINTS), -80.0)
    assert drop_leading_tpose(clip_of(np.concatenate([glitch, walk()])))[0].frames == 41


def test_fast_motion_at_a_low_rate_is_kept() -> None:
    rng = np.random.default_rng(0)
    jerky = np.concatenate([t_pose(), rng.uniform(-60, 60, (20, JOINTS))])
    assert drop_leading_tpose(clip_of(jerky, fps=5))[0].frames == 21


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_clips_too_short_to_tell_are_kept(frames: int) -> None:
    angles = np.concatenate([t_pose(), walk()])[:frames]
    assert drop_leading_tpose(clip_of(angles))[0].frames == frames


def test_a_held_t_pose_is_kept() -> None:
    clip = clip_of(t_pose(30))
    assert drop_leading_tpose(clip)[0].frames == 30
