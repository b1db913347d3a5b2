"""Motions that tests make for themselves."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion


def random_motion(
    frames: int, fps: float = 20.0, seed: int = 0, root: tuple[float, float, float] = (0, 0.9, 0)
) -> Motion:
    """Smooth but otherwise arbitrary rotations of all joints, walking a random line."""
    rng = np.random.default_rng(seed)
    vectors = rng.normal(0, 0.3, (1, 24, 3)) + np.cumsum(rng.normal(0, 0.04, (frames, 24, 3)), axis=0)
    path = np.asarray(root) + np.cumsum(rng.normal(0, 0.02, (frames, 3)), axis=0)
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(frames, 24, 3, 3)
    return Motion(matrices.astype(np.float32), path.astype(np.float32), fps)


def standing(frames: int = 1, fps: float = 20.0) -> Motion:
    """The rest pose, toes on the floor."""
    toe = SMPL24.rest_positions[SMPL24.index("left_foot"), 1]
    root = np.tile(np.array([0, -toe, 0], np.float32), (frames, 1))
    return Motion(np.tile(np.eye(3, dtype=np.float32), (frames, 24, 1, 1)), root, fps)


def walking(frames: int = 60, fps: float = 20.0, speed: float = 1.2, turn: float = 0.0) -> Motion:
    """A simple gait: legs and arms swing at 1 Hz, the root moves ahead at ``speed`` m/s, turning ``turn`` rad/s."""
    time = np.arange(frames) / fps
    swing = 0.5 * np.sin(2 * np.pi * time)
    vectors = np.zeros((frames, 24, 3))
    for name, sign in (("left_hip", 1), ("right_hip", -1), ("left_shoulder", -0.5), ("right_shoulder", 0.5)):
        vectors[:, SMPL24.index(name), 0] = -sign * swing
    vectors[:, 0, 1] = turn * time
    yaw = vectors[:, 0, 1]
    step = np.stack([np.sin(yaw), np.zeros(frames), np.cos(yaw)], axis=1) * speed / fps
    root = standing().root[0] + np.cumsum(step, axis=0)
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(frames, 24, 3, 3)
    return Motion(matrices.astype(np.float32), root.astype(np.float32), fps)
