"""``ccf219``: 24 joints x flattened 3x3 rotation (216) + root translation (3)  [Continual 3.5].

Per frame: columns 0:216 the rotation matrices row by row (local to the parent, the pelvis' global), 216:219 the
pelvis' position in metres.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.features.checks import checked_features
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import project_to_so3
from motionrt.motion.skeleton import SMPL24, FloatArray

WIDTH = 219
FPS = 30.0
ROTATIONS = slice(0, 216)
ROOT = slice(216, 219)


def encode(motion: Motion) -> FloatArray:
    """``(F, 219)`` float32 features of a ``smpl24`` motion, at the motion's own frame rate."""
    return by_batches(_rows, motion.rotations, motion.root)


def _rows(turns: FloatArray, root: FloatArray) -> FloatArray:
    return np.concatenate([turns.reshape(len(turns), -1), root], axis=1)


def decode(features: FloatArray, fps: float = FPS) -> Motion:
    """Inverse of :func:`encode`, exact for rotations; predicted matrices are projected to the nearest rotations."""
    x = checked_features(features, WIDTH)
    rotations = project_to_so3(x[:, ROTATIONS].reshape(len(x), len(SMPL24), 3, 3))
    return Motion(rotations, x[:, ROOT], fps)
