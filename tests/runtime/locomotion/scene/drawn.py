"""Small worlds drawn as text and as boxes, and plain searches to compare with."""

from __future__ import annotations

import heapq
import math

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.scene import Agent, Scene

Mask = npt.NDArray[np.bool_]
STEPS = [(r, c) for r in (-1, 0, 1) for c in (-1, 0, 1) if r or c]


def mask(picture: str) -> Mask:
    """Rows of ``.`` (walkable) and ``#``."""
    return np.array([[letter == "." for letter in row] for row in picture.split()])


def scene(picture: str, *, radius: float = 0.0, comfort: float = 0.0, cell: float = 1.0) -> Scene:
    """A drawn scene; the first row is the lowest z."""
    return Scene.from_cells(mask(picture), cell, agent=Agent(radius=radius, comfort=comfort))


def shortest(free: Mask, start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Length in cells of the shortest 8-connected way without cut corners, by a textbook Dijkstra; inf if none."""
    best, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        length, (r, c) = heapq.heappop(queue)
        if (r, c) == goal:
            return length
        for dr, dc in STEPS:
            cells = [(r + dr, c + dc), (r + dr, c), (r, c + dc)]
            if not all(0 <= y < free.shape[0] and 0 <= x < free.shape[1] and free[y, x] for y, x in cells):
                continue
            longer = length + math.hypot(dr, dc)
            if longer < best.get(cells[0], math.inf) - 1e-12:
                best[cells[0]] = longer
                heapq.heappush(queue, (longer, cells[0]))
    return math.inf


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A closed box, faces counter-clockwise seen from outside."""
    corners = np.array(
        [[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners, np.array(faces)


def joined(*meshes: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Several meshes as one."""
    firsts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return np.concatenate([v for v, _ in meshes]), np.concatenate(
        [f + n for (_, f), n in zip(meshes, firsts, strict=False)]
    )
