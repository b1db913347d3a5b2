"""Between motionrt's axes (Y up, facing +Z) and Blender's (Z up, facing -Y), and between joints and bones.

A joint of motionrt has no rotation at rest; a bone has a rest matrix. With a bone's rest rotation ``B`` in the armature
and a joint's local rotation ``L`` in Blender's axes, the pose bone's own rotation is ``B^-1 L B``.
"""

from __future__ import annotations

import numpy as np

TO_BLENDER = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # (x, y, z) -> (x, -z, y)


def points(metres: np.ndarray) -> np.ndarray:
    """Points ``(..., 3)`` of motionrt in Blender's axes."""
    return metres @ TO_BLENDER.T


def points_back(metres: np.ndarray) -> np.ndarray:
    """Inverse of :func:`points`."""
    return metres @ TO_BLENDER


def turns(matrices: np.ndarray) -> np.ndarray:
    """Rotations ``(..., 3, 3)`` of motionrt in Blender's axes."""
    return TO_BLENDER @ matrices @ TO_BLENDER.T


def turns_back(matrices: np.ndarray) -> np.ndarray:
    """Inverse of :func:`turns`."""
    return TO_BLENDER.T @ matrices @ TO_BLENDER


def steady(quaternions: np.ndarray) -> np.ndarray:
    """Quaternions ``(F, ..., 4)`` with signs that never jump from frame to frame, so that curves do not spin."""
    dots = (quaternions[1:] * quaternions[:-1]).sum(-1)
    flips = np.cumprod(np.where(dots < 0, -1.0, 1.0), axis=0)
    return np.concatenate([quaternions[:1], quaternions[1:] * flips[..., None]])


def quaternions(matrices: np.ndarray) -> np.ndarray:
    """Rotations ``(F, 3, 3)`` as quaternions ``(F, 4)`` wxyz whose signs never jump."""
    from motionrt.motion.rotations import matrix_to_quaternion

    return steady(matrix_to_quaternion(matrices))
