"""Forward kinematics and its bookkeeping between local and global rotations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.motion.rotations import Array


def fk(rotations: Array, root: Array, offsets: Array, parents: Sequence[int]) -> tuple[Array, Array]:
    """Forward kinematics.

    Args:
        rotations: ``(..., J, 3, 3)`` local to the parent.
        root: ``(..., 3)`` position of joint 0, metres.
        offsets: ``(J, 3)`` from the parent in the rest pose, or ``(..., J, 3)`` where they change over time.
        parents: ``J`` indices, parents before children, ``-1`` for the root.

    Returns:
        Global joint positions ``(..., J, 3)`` and global rotations ``(..., J, 3, 3)``.
    """
    positions = np.empty(rotations.shape[:-1], dtype=rotations.dtype)
    turned = np.empty_like(rotations)
    for joint, parent in enumerate(parents):
        if parent < 0:
            positions[..., joint, :] = root
            turned[..., joint, :, :] = rotations[..., joint, :, :]
            continue
        step = turned[..., parent, :, :] @ offsets[..., joint, :, None]
        positions[..., joint, :] = positions[..., parent, :] + step[..., 0]
        turned[..., joint, :, :] = turned[..., parent, :, :] @ rotations[..., joint, :, :]
    return positions, turned


def global_to_local(rotations: Array, parents: Sequence[int]) -> Array:
    """Global rotations ``(..., J, 3, 3)`` -> rotations local to the parent, same shape."""
    out = rotations.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            out[..., joint, :, :] = np.swapaxes(rotations[..., parent, :, :], -1, -2) @ rotations[..., joint, :, :]
    return out
