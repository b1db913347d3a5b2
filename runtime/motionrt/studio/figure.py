"""The figure: one smooth skin over the skeleton, made of round cones that melt into each other.

The skin is the level set of a smooth minimum over the distances to the cones, taken in the rest pose by surface nets;
every vertex follows the bones whose cones are near.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24, FloatArray, Skeleton
from motionrt.studio.figure_cones import Cones, cones_of
from motionrt.studio.surface import surface_net

CELL = 0.018  # metres, of the net
MELT = 0.018  # metres over which cones melt into each other
SOFTNESS = 0.016  # metres over which a vertex passes from one bone to the next
INFLUENCES = 4  # bones of a vertex
_CHUNK = 60_000  # points whose distances are held in memory at once


@dataclass(frozen=True, eq=False)
class Figure:
    """A skinned mesh in the rest pose; bone ``b`` is joint ``b`` of the skeleton (hands move with their wrists).

    Attributes:
        vertices: ``(V, 3)`` float32 metres, pelvis at the origin.
        faces: ``(T, 3)`` uint32, counter-clockwise from outside.
        weights: ``(V, B)`` float32, rows sum to 1, at most four of a row are not 0.
        bones: ``(B, 3)`` float32, where the joints are in the rest pose.
    """

    vertices: FloatArray
    faces: npt.NDArray[np.uint32]
    weights: FloatArray
    bones: FloatArray


@lru_cache(maxsize=8)
def figure_of(skeleton: Skeleton = SMPL24) -> Figure:
    """The figure of a skeleton with the joints of ``smpl24``, whatever its proportions."""
    cones = cones_of(skeleton)
    low, high = cones.bounds(MELT + 2 * CELL)
    vertices, faces = surface_net(lambda points: skin_distance(cones, points), low, high, CELL)
    bones = skeleton.rest_positions[:SMPL22_JOINTS]
    return Figure(vertices, faces, skin_weights(cones, vertices, len(bones)), bones)


def skin_distance(cones: Cones, points: FloatArray) -> FloatArray:
    """``(N,)`` metres from points ``(N, 3)`` to the skin, negative inside: a smooth minimum over the cones."""
    parts = np.array_split(points, max(1, len(points) // _CHUNK))
    return np.concatenate([_smooth_minimum(cones.distances(part)) for part in parts])


def _smooth_minimum(distances: FloatArray) -> FloatArray:
    nearest = distances.min(axis=1)
    near = np.exp((nearest[:, None] - distances) / MELT).sum(axis=1)
    return np.asarray(nearest - MELT * np.log(near), dtype=np.float32)


def skin_weights(cones: Cones, vertices: FloatArray, bones: int) -> FloatArray:
    """``(V, bones)``: how much every vertex follows every bone, by the distance to the bone's nearest cone."""
    distances = cones.distances(vertices)
    nearest = np.full((len(vertices), bones), np.inf, dtype=np.float32)
    for cone, bone in enumerate(cones.bones):
        nearest[:, bone] = np.minimum(nearest[:, bone], distances[:, cone])
    weights = np.exp((nearest.min(axis=1, keepdims=True) - nearest) / SOFTNESS)
    weights[weights < np.sort(weights, axis=1)[:, -INFLUENCES, None]] = 0
    return np.asarray(weights / weights.sum(axis=1, keepdims=True), dtype=np.float32)
