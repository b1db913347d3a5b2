"""A* on a roadmap, by SciPy's compiled Dijkstra on reduced costs."""

from __future__ import annotations

import numpy as np

from motionrt.locomotion.scene.grid import IntArray, Points
from motionrt.locomotion.scene.roadmap import Roadmap

_UNREACHED = -9999  # SciPy's mark
_GROWTH = 3.0


def cheapest_route(roadmap: Roadmap, start: int, goal: int) -> IntArray | None:
    """Nodes of the cheapest route from ``start`` to ``goal``, both included; ``None`` if there is none.

    A* with the straight distance ``h`` to the goal is Dijkstra on the reduced costs ``w(u, v) - h(u) + h(v)``, none
    of which is negative as a metre costs at least 1. Like A*, the search leaves out what costs more than a bound; it
    grows from a small detour until the goal lies within.
    """
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    if start == goal:
        return np.array([start])
    if roadmap.areas[start] != roadmap.areas[goal]:
        return None
    edges, away = roadmap.edges, _distance(roadmap.points, roadmap.points[goal])
    reduced = edges.data - np.repeat(away, np.diff(edges.indptr)) + away[edges.indices]
    graph = csr_matrix((np.maximum(reduced, 1e-9), edges.indices, edges.indptr), shape=edges.shape)
    bound = 0.3 * away[start] + 1.0
    while True:
        detour, before = dijkstra(graph, indices=start, limit=bound, return_predecessors=True)
        if np.isfinite(detour[goal]):
            return _traced(before, goal)
        bound *= _GROWTH


def _distance(points: Points, goal: Points) -> Points:
    return np.asarray(np.linalg.norm(points - goal, axis=1))


def _traced(before: IntArray, goal: int) -> IntArray:
    route = [goal]
    while before[route[-1]] != _UNREACHED:
        route.append(int(before[route[-1]]))
    return np.array(route[::-1])
