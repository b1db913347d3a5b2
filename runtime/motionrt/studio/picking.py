"""What a click in the picture means: where its ray meets the ground, points or triangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

REACH = 0.08  # metres from the ray within which a point is hit
FARTHEST = 200.0  # metres


def ground_hit(origin: npt.ArrayLike, direction: npt.ArrayLike, level: float = 0.0) -> FloatArray | None:
    """``(3,)`` where a ray meets the plane y = ``level``; None if it does not, or only very far away."""
    start, way = _ray(origin, direction)
    if abs(way[1]) < 1e-6:
        return None
    far = (level - start[1]) / way[1]
    return (start + far * way).astype(np.float32) if 0 < far < FARTHEST else None


def point_hit(origin: npt.ArrayLike, direction: npt.ArrayLike, points: FloatArray) -> FloatArray | None:
    """The first of points ``(N, 3)`` within reach of a ray; of neighbours that of the smallest distance from it."""
    start, way = _ray(origin, direction)
    along = (points - start) @ way
    apart = np.linalg.norm(points - start - along[:, None] * way, axis=1)
    near = np.flatnonzero((along > 0) & (apart < REACH))
    if not len(near):
        return None
    front = near[along[near] < along[near].min() + 2 * REACH]
    return np.asarray(points[front[apart[front].argmin()]], dtype=np.float32)


def triangle_hit(origin: npt.ArrayLike, direction: npt.ArrayLike, triangles: FloatArray) -> FloatArray | None:
    """``(3,)`` where a ray first meets triangles ``(T, 3, 3)``, from either side (Moeller and Trumbore)."""
    start, way = _ray(origin, direction)
    a, edge1, edge2 = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(way, edge2)
    volume = (edge1 * across).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        offset = start - a
        u = (offset * across).sum(axis=1) / volume
        turned = np.cross(offset, edge1)
        v = (turned @ way) / volume
        far = (edge2 * turned).sum(axis=1) / volume
    met = (np.abs(volume) > 1e-12) & (u >= -1e-6) & (v >= -1e-6) & (u + v <= 1 + 1e-6) & (far > 0) & (far < FARTHEST)
    return (start + far[met].min() * way).astype(np.float32) if met.any() else None


def nearest(origin: npt.ArrayLike, hits: Sequence[FloatArray | None]) -> FloatArray | None:
    """The hit nearest to where the ray begins."""
    found = [hit for hit in hits if hit is not None]
    return min(found, key=lambda hit: float(np.linalg.norm(hit - np.asarray(origin))), default=None)


def _ray(origin: npt.ArrayLike, direction: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    way = np.asarray(direction, dtype=np.float64)
    return np.asarray(origin, dtype=np.float64), way / max(float(np.linalg.norm(way)), 1e-12)
