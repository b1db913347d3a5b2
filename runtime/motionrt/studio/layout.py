"""Where clips stand on the stage, and from where the camera sees them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

OVERLAID, SIDE_BY_SIDE, AS_RECORDED = "overlaid", "side by side", "as recorded"
LAYOUTS = (AS_RECORDED, SIDE_BY_SIDE, OVERLAID)
GAP = 0.7  # metres between the boxes of neighbours
SOMEBODY = ((-0.5, 0.0, -0.5), (0.5, 1.7, 0.5))  # metres, a box around a person who stands
VIEW_FROM = (-0.55, 0.42, 1.0)
MARGIN, LEAST_DISTANCE = 1.12, 3.2  # of the picture around what is framed; metres
Vector = npt.NDArray[np.float64]


def offsets(boxes: Sequence[FloatArray], starts: Sequence[FloatArray], layout: str) -> FloatArray:
    """``(N, 3)`` by how much every clip is moved, metres; heights stay.

    Args:
        boxes: ``(2, 3)`` of each, lowest and highest corner.
        starts: ``(3,)`` of each, the pelvis in the first frame.
        layout: ``"as recorded"`` moves nothing; ``"overlaid"`` brings all starts above the origin; ``"side by side"``
            puts the boxes into a row along x without overlap, its middle at x = 0, starts at z = 0.
    """
    out = np.zeros((len(boxes), 3), dtype=np.float32)
    if layout == AS_RECORDED or not boxes:
        return out
    out[:, [0, 2]] = -np.array(starts, dtype=np.float32)[:, [0, 2]]
    if layout == SIDE_BY_SIDE:
        widths = np.array([box[1, 0] - box[0, 0] for box in boxes])
        lefts = np.append(0, np.cumsum(widths + GAP)[:-1]) - (widths.sum() + GAP * (len(boxes) - 1)) / 2
        out[:, 0] = lefts - [box[0, 0] for box in boxes]
    return out


def frame_all(
    boxes: Sequence[FloatArray], fov: float, aspect: float, covered: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Camera place and target, ``(3,)`` each, from where all boxes ``(2, 3)`` are in sight, seen from the front left.

    Args:
        boxes: lowest and highest corners, metres; none is a box around a standing person.
        fov: vertical field of view, radians.
        aspect: width of the picture over its height.
        covered: share of the width that a panel covers at the right.
    """
    corners = np.array(boxes if len(boxes) else [SOMEBODY], dtype=np.float64)
    low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
    target = (low + high) / 2
    back = np.array(VIEW_FROM) / np.linalg.norm(VIEW_FROM)
    right = np.cross([0, 1, 0], back) / np.linalg.norm(np.cross([0, 1, 0], back))
    tall = math.tan(fov / 2)
    wide = tall * aspect
    away = _distance(low, high, back, right, wide, tall, covered)
    target = target + right * away * wide * covered
    return (target + away * back).astype(np.float32), target.astype(np.float32)


def _distance(
    low: Vector, high: Vector, back: Vector, right: Vector, wide: float, tall: float, covered: float
) -> float:
    """How far back the camera goes so that all eight corners are in the part of the picture that is not covered.

    The camera, ``d`` metres back, is ``d * wide * covered`` to the right; a corner ``x`` to the right, ``y`` up and
    ``z`` towards the camera appears at ``(x - d * wide * covered) / (d - z)`` and ``y / (d - z)``.
    """
    up = np.cross(back, right)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    offsets = corners - (low + high) / 2
    x, y, z = offsets @ right, offsets @ up, offsets @ back
    shift, left, height = wide * covered, wide / MARGIN, tall / MARGIN
    free = wide * (1 - 2 * covered) / MARGIN
    needed = [(left * z - x) / (left - shift), (free * z + x) / (free + shift), np.abs(y) / height + z]
    return max(float(np.max(needed)), LEAST_DISTANCE)
