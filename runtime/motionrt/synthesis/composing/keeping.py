"""The lean of a donor: a torso that was upright stays upright on hips that lean, if that is wanted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation
from motionrt.motion.skeleton import SMPL24, FloatArray
from motionrt.synthesis.composing.ownership import Weights


def lean(rotations: Array) -> Array:
    """Global rotations ``(..., 3, 3)`` without their turn about the vertical axis (swing of a swing-twist split)."""
    turn = np.arctan2(rotations[..., 0, 2] - rotations[..., 2, 0], rotations[..., 0, 0] + rotations[..., 2, 2])
    return np.asarray(np.swapaxes(axis_rotation("Y", turn), -1, -2) @ rotations)


def keep_lean(rotations: FloatArray, layers: Sequence[Motion], weights: Weights) -> FloatArray:
    """Local rotations ``(F, 24, 3, 3)`` in which every layer leans against the vertical as it did by itself.

    The first joint of each chain that a layer owns alone is turned by the difference between its parent's lean in
    the layer and here; its turn about the vertical goes with the parent it has now. Joints behind it stay as they are.
    """
    out = rotations.astype(np.float64)
    turned = out.copy()
    for joint, parent in enumerate(SMPL24.parents):
        if parent < 0:
            continue
        owner = int(np.argmax(weights[:, joint]))
        if weights[owner, joint] == 1 and weights[owner, parent] < 1:
            there, here = layers[owner].global_rotations()[:, parent].astype(np.float64), turned[:, parent]
            out[:, joint] = np.swapaxes(lean(here), -1, -2) @ lean(there) @ out[:, joint]
        turned[:, joint] = turned[:, parent] @ out[:, joint]
    near = np.abs(out - rotations).max(axis=(-2, -1), keepdims=True) < 1e-6  # nothing to correct: the very same bits
    return np.asarray(np.where(near, rotations, out), dtype=np.float32)
