"""What a composed body keeps of its donors: the height of the feet over the ground, and how upright a torso was."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from motionrt.motion.feet.two_bone import LEG_JOINTS
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation
from motionrt.motion.skeleton import SMPL24, FloatArray
from motionrt.motion.transforms import TOE_JOINTS
from motionrt.synthesis.composing.ownership import Weights

_LEGS = [joint for leg in LEG_JOINTS for joint in leg]


def on_their_ground(motion: Motion, layers: Sequence[Motion], weights: Weights) -> Motion:
    """``motion`` with its lower toe as high as the lower toe of the layers that the legs come from, in every frame.

    Nothing changes where pelvis and legs come from one layer.
    """
    if all(np.array_equal(weights[:, joint], weights[:, 0]) for joint in _LEGS) and weights[:, 0].max() == 1:
        return motion
    toes = [motion.skeleton.index(name) for name in TOE_JOINTS]
    heights = np.stack([_toes(layer, toes) for layer in layers])
    wanted = np.einsum("lt,lft->ft", weights[:, toes], heights).min(axis=1)
    lift = np.zeros((motion.frames, 3), dtype=np.float32)
    lift[:, 1] = wanted - _toes(motion, toes).min(axis=1)
    return replace(motion, root=motion.root + lift)


def _toes(motion: Motion, toes: list[int]) -> Array:
    return motion.positions()[:, toes, 1]


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
