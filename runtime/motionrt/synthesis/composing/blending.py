"""Rotations of several layers mixed on the sphere; what one layer owns alone is copied bit for bit."""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, matrix_to_quaternion, quaternion_to_matrix, slerp
from motionrt.motion.skeleton import FloatArray
from motionrt.synthesis.composing.ownership import Weights


def mixed_rotations(layers: list[FloatArray], weights: Weights) -> FloatArray:
    """Layers of ``(F, 24, 3, 3)`` and their shares ``(L, 24)`` -> ``(F, 24, 3, 3)``, blended by slerp one by one."""
    out = np.empty_like(layers[0])
    for joint in range(weights.shape[1]):
        owners = np.flatnonzero(weights[:, joint])
        out[:, joint] = layers[owners[0]][:, joint]
        total = weights[owners[0], joint]
        for owner in owners[1:]:
            total += weights[owner, joint]
            out[:, joint] = blended(out[:, joint], layers[owner][:, joint], weights[owner, joint] / total)
    return out


def mixed_roots(layers: list[FloatArray], weights: Weights) -> FloatArray:
    """Layers of ``(F, 3)`` and the pelvis' shares ``(L,)`` -> ``(F, 3)``."""
    if np.count_nonzero(weights) == 1:
        return layers[int(np.argmax(weights))].copy()
    return np.asarray(np.einsum("l,lfc->fc", weights, np.stack(layers)), dtype=np.float32)


def blended(start: Array, end: Array, weight: Array | float) -> FloatArray:
    """Slerp from ``start`` to ``end`` ``(..., 3, 3)``, the shorter way; equal ones stay as they are, bit for bit."""
    q0, q1 = matrix_to_quaternion(start.astype(np.float64)), matrix_to_quaternion(end.astype(np.float64))
    found = quaternion_to_matrix(slerp(q0, q1, np.asarray(weight)))
    same = (start == end).all(axis=(-2, -1), keepdims=True)
    return np.asarray(np.where(same, start, found), dtype=np.float32)
