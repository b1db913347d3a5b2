"""A body for a bare skeleton: one octahedron a bone, so that every viewer shows something."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.motion.rotations import Array, normalise, rotation_between

FACES = 8
_WAIST_AT, _WAIST_WIDTH = 0.18, 0.09
_SQUARE = np.array([[1.0, 0, 1], [1, 0, -1], [-1, 0, -1], [-1, 0, 1]])
_SHORTEST = 1e-6


def bone_mesh(
    joints: Array, parents: Sequence[int], tips: dict[int, Array]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[np.int64]]:
    """Flat-shaded octahedra from every joint to each of its children and to its tip.

    Args:
        joints: ``(J, 3)`` joint positions in the rest pose.
        parents: ``J`` parent indices, ``-1`` for roots.
        tips: ``(3,)`` ends of last bones, same space.

    Returns:
        Corner positions ``(V, 3)`` and unit normals ``(V, 3)``, three corners a triangle, counter-clockwise from
        outside; and the joint ``(V,)`` that carries each.
    """
    bones = [(parent, joints[parent], joints[joint]) for joint, parent in enumerate(parents) if parent >= 0]
    bones += [(joint, joints[joint], tip) for joint, tip in tips.items()]
    bones = [bone for bone in bones if np.linalg.norm(bone[2] - bone[1]) > _SHORTEST]
    if not bones:  # a single joint: a drop of 10 cm, so that there is something to see
        bones = [(0, joints[0], joints[0] + [0.0, 0.1, 0.0])]
    corners = np.stack([_octahedron(start, end) for _, start, end in bones])  # (B, 8, 3, 3)
    normals = normalise(np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0]))
    normals = np.repeat(normals[:, :, None], 3, axis=2)
    carriers = np.repeat(np.array([joint for joint, _, _ in bones]), 3 * FACES)
    return corners.reshape(-1, 3).astype(np.float32), normals.reshape(-1, 3).astype(np.float32), carriers


def _octahedron(start: Array, end: Array) -> Array:
    """Eight triangles ``(8, 3, 3)``: a square waist near ``start`` and a point at either end."""
    length = float(np.linalg.norm(end - start))
    turn = rotation_between(np.array([0.0, 1.0, 0.0]), end - start)
    waist = start + length * (_SQUARE * _WAIST_WIDTH + [0, _WAIST_AT, 0]) @ turn.T
    following = np.roll(waist, -1, axis=0)
    low = np.stack([np.broadcast_to(start, (4, 3)), following, waist], axis=1)
    high = np.stack([np.broadcast_to(end, (4, 3)), waist, following], axis=1)
    return np.concatenate([low, high])
