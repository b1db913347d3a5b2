"""Small meshes that the stage is furnished with: vertices ``(V, 3)`` and faces ``(T, 3)``, Y up, metres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

Faces = npt.NDArray[np.uint32]
Mesh = tuple[FloatArray, Faces]


def disc(radius: float, sides: int = 28) -> Mesh:
    """A disc on the ground that faces up."""
    return ring(0.0, radius, sides)


def ring(inner: float, outer: float, sides: int = 36) -> Mesh:
    """A flat ring on the ground that faces up."""
    angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    circle = np.stack([np.sin(angles), np.zeros(sides), np.cos(angles)], axis=1)
    here = np.arange(sides)
    there = (here + 1) % sides
    faces = np.concatenate(
        [np.stack([here, sides + here, there], 1), np.stack([there, sides + here, sides + there], 1)]
    )
    return np.concatenate([inner * circle, outer * circle]).astype(np.float32), faces.astype(np.uint32)


def arrow(length: float = 0.45, width: float = 0.16) -> Mesh:
    """A flat arrow head on the ground that points along +Z."""
    points = [(0, 0, length), (width, 0, 0), (0, 0, length * 0.22), (-width, 0, 0)]
    vertices = np.array(points, dtype=np.float64)
    return vertices.astype(np.float32), facing_up(vertices, np.array([[0, 1, 2], [0, 2, 3]]))


def ribbon(points: npt.NDArray[np.float32], width: float, height: float = 0.0) -> Mesh:
    """A flat band along a polyline ``(N, 2)`` of x and z; fewer than two points give no triangles."""
    if len(points) < 2:
        return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32)
    ways = np.gradient(points.astype(np.float64), axis=0)
    lengths = np.maximum(np.linalg.norm(ways, axis=1, keepdims=True), 1e-9)
    aside = (ways / lengths)[:, ::-1] * (-1, 1) * width / 2  # to the right of the way, seen from above
    flat = np.concatenate([points - aside, points + aside])
    here = np.arange(len(points) - 1)
    left, right = here, here + len(points)
    faces = np.concatenate([np.stack([left, right, left + 1], 1), np.stack([left + 1, right, right + 1], 1)])
    return np.insert(flat, 1, height, axis=1).astype(np.float32), facing_up(np.insert(flat, 1, 0, axis=1), faces)


def facing_up(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> Faces:
    """The same triangles, all counter-clockwise from above."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    down = np.cross(b - a, c - a)[:, 1] < 0
    out = faces.copy()
    out[down] = out[down][:, ::-1]
    return np.asarray(out, dtype=np.uint32)


def boxes(lows: npt.NDArray[np.float32], highs: npt.NDArray[np.float32]) -> Mesh:
    """``N`` boxes as one mesh, from their lowest ``(N, 3)`` and highest ``(N, 3)`` corners."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=np.float32)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    cube = np.array([face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))], dtype=np.uint32)
    vertices = lows[:, None] + corners * (highs - lows)[:, None]
    faces = cube[None] + 8 * np.arange(len(lows), dtype=np.uint32)[:, None, None]
    return vertices.reshape(-1, 3), faces.reshape(-1, 3).astype(np.uint32)


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes as one."""
    if not meshes:
        return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32)
    counts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    faces = [faces + np.uint32(count) for (_, faces), count in zip(meshes, counts, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(faces).astype(np.uint32)
