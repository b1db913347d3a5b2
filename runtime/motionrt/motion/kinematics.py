"""Forward kinematics and its bookkeeping between local and global rotations."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from motionrt.motion.rotations import Array


class _Level(NamedTuple):
    """Joints that are equally far from the root: where they are in level order, and where their parents are."""

    joints: slice
    parents: npt.NDArray[np.intp]


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
    order, back, levels = _levels(tuple(parents))
    posed = _columns(rotations, root, offsets, order)  # local at first; level after level becomes global
    for joints, above in levels:
        parent, own = posed[:, :, above], posed[:, :, joints]
        moved = parent[:, 0, None] * own[0]
        moved += parent[:, 1, None] * own[1]
        moved += parent[:, 2, None] * own[2]
        moved[:, 3] += parent[:, 3]
        own[...] = moved
    posed = posed[:, :, back].transpose(3, 2, 0, 1)  # (N, J, 3, 4)
    turned = np.ascontiguousarray(posed[..., :3]).reshape(rotations.shape)
    return np.ascontiguousarray(posed[..., 3]).reshape(rotations.shape[:-1]), turned


def _columns(rotations: Array, root: Array, offsets: Array, order: npt.NDArray[np.intp]) -> Array:
    """``(3, 4, J, N)``: rotation and offset of every joint, frames last, which is what NumPy goes through fastest."""
    joints = len(order)
    posed = np.empty((3, 4, joints, rotations.size // (9 * joints)), dtype=rotations.dtype)
    posed[:, :3] = rotations.reshape(-1, joints, 3, 3).transpose(2, 3, 1, 0)[:, :, order]
    posed[:, 3] = offsets.reshape(-1, joints, 3).transpose(2, 1, 0)[:, order]
    posed[:, 3, 0] = np.broadcast_to(root, (*rotations.shape[:-3], 3)).reshape(-1, 3).T
    return posed


@lru_cache(maxsize=64)
def _levels(parents: tuple[int, ...]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], tuple[_Level, ...]]:
    """The joints by their distance from the root, the way back from that order, and the levels below the root."""
    depths = [0] * len(parents)
    for joint, parent in enumerate(parents):
        depths[joint] = depths[parent] + 1 if parent >= 0 else 0
    order = np.argsort(depths, kind="stable")
    back = np.argsort(order)
    ends = np.cumsum(np.bincount(depths))
    levels = [
        _Level(slice(int(start), int(stop)), back[[parents[joint] for joint in order[start:stop]]])
        for start, stop in pairwise(ends)
    ]
    return order, back, tuple(levels)


def global_to_local(rotations: Array, parents: Sequence[int]) -> Array:
    """Global rotations ``(..., J, 3, 3)`` -> rotations local to the parent, same shape."""
    out = rotations.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            out[..., joint, :, :] = np.swapaxes(rotations[..., parent, :, :], -1, -2) @ rotations[..., joint, :, :]
    return out
