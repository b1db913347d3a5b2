"""A level set as triangles, by surface nets: one vertex in every cell that the surface crosses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

Distance = Callable[[FloatArray], FloatArray]
_STEPS = 3  # of Newton's method onto the surface
_PROBE = 1e-3  # metres


def surface_net(
    distance: Distance, low: FloatArray, high: FloatArray, cell: float
) -> tuple[FloatArray, npt.NDArray[np.uint32]]:
    """Triangles of the surface where ``distance`` is 0.

    Args:
        distance: of points ``(N, 3)``, ``(N,)``, negative inside; close to a true distance near the surface.
        low: lowest corner ``(3,)`` of a box with the surface inside.
        high: its highest corner.
        cell: edge of the cells.

    Returns:
        Vertices ``(V, 3)`` on the surface, and faces ``(T, 3)``, counter-clockwise from outside.
    """
    shape = np.ceil((np.asarray(high) - low) / cell).astype(int) + 1
    corners = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    points = (np.asarray(low) + cell * corners.reshape(-1, 3)).astype(np.float32)
    inside = distance(points).reshape(shape) < 0
    crossed = _crossed_cells(inside)
    numbers = np.full(crossed.shape, -1, dtype=np.int64)
    numbers[crossed] = np.arange(crossed.sum())
    middles = (np.asarray(low) + cell * (np.argwhere(crossed) + 0.5)).astype(np.float32)
    return _onto(distance, middles, cell), _faces(inside, numbers)


def _crossed_cells(inside: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Cells with corners on either side."""
    ends = (slice(None, -1), slice(1, None))
    corners = [inside[x, y, z] for x in ends for y in ends for z in ends]
    return np.asarray(np.any(corners, axis=0) & ~np.all(corners, axis=0))


def _onto(distance: Distance, points: FloatArray, cell: float) -> FloatArray:
    """Points moved onto the surface, by no more than a cell a step."""
    for _ in range(_STEPS):
        here = distance(points)
        slope = np.stack(
            [(distance(points + _PROBE * axis) - here) / _PROBE for axis in np.eye(3, dtype=np.float32)], 1
        )
        step = np.clip(here, -cell, cell) / np.maximum((slope**2).sum(axis=1), 0.1)
        points = (points - step[:, None] * slope).astype(np.float32)
    return points


def _faces(inside: npt.NDArray[np.bool_], numbers: npt.NDArray[np.int64]) -> npt.NDArray[np.uint32]:
    """Two triangles for every edge of the grid that crosses the surface, between the four cells around it."""
    found = []
    for axis in range(3):
        turned = np.moveaxis(inside, (axis, (axis + 1) % 3, (axis + 2) % 3), (0, 1, 2))
        cells = np.moveaxis(numbers, (axis, (axis + 1) % 3, (axis + 2) % 3), (0, 1, 2))
        near, far = turned[:-1, 1:-1, 1:-1], turned[1:, 1:-1, 1:-1]
        around = np.stack([cells[:, :-1, :-1], cells[:, 1:, :-1], cells[:, 1:, 1:], cells[:, :-1, 1:]], axis=-1)
        found += [around[near & ~far], around[~near & far][:, ::-1]]
    quads = np.concatenate(found)
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.uint32)
