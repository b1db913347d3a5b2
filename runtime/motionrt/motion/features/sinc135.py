"""``sinc135``: 22 joints x 6D rotation, ground-plane trajectory (2), height (1)  [SINC 3.3].

Per frame: columns 0:132 the 6D rotations of the first 22 joints (local to the parent, the pelvis' global), 132:134
the pelvis' x and z in metres, 134 its height y in metres. Hands are not described; they decode to the wrist's pose.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.features.checks import checked_features
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import matrix_from_6d, matrix_to_6d
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24, FloatArray

WIDTH = 135
FPS = 30.0
ROTATIONS = slice(0, 132)
TRAJECTORY = slice(132, 134)
HEIGHT = slice(134, 135)


def encode(motion: Motion) -> FloatArray:
    """``(F, 135)`` float32 features of a ``smpl24`` motion, at the motion's own frame rate."""
    return by_batches(_rows, motion.rotations, motion.root)


def _rows(turns: FloatArray, root: FloatArray) -> FloatArray:
    rotations = matrix_to_6d(turns[:, :SMPL22_JOINTS]).reshape(len(turns), -1)
    return np.concatenate([rotations, root[:, [0, 2]], root[:, 1:2]], axis=1).astype(np.float32)


def decode(features: FloatArray, fps: float = FPS) -> Motion:
    """Exact inverse of :func:`encode` for 22 joints; rotations are re-orthonormalised (Gram-Schmidt)."""
    x = checked_features(features, WIDTH)
    rotations = np.tile(np.eye(3, dtype=np.float32), (len(x), len(SMPL24), 1, 1))
    rotations[:, :SMPL22_JOINTS] = matrix_from_6d(x[:, ROTATIONS].reshape(len(x), SMPL22_JOINTS, 6))
    planar, height = x[:, TRAJECTORY], x[:, HEIGHT]
    return Motion(rotations, np.concatenate([planar[:, :1], height, planar[:, 1:]], axis=1), fps)
