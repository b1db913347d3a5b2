"""Why there is no path: how wide the widest way is, and where it is narrowest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.errors import PathError
from motionrt.locomotion.scene.ends import End, spoken
from motionrt.locomotion.scene.grid import Grid, Points, label
from motionrt.locomotion.scene.penalty import Penalty
from motionrt.locomotion.scene.roadmap import build_roadmap
from motionrt.locomotion.scene.search import cheapest_route

_PRECISION = 0.005


def widest_way(grid: Grid, start: Points, goal: Points) -> float | None:
    """The largest radius in metres that an agent could have to get from ``start`` to ``goal``; ``None`` for no way."""
    places = np.stack([start, goal])
    if not _joined(grid, places, 0.0):
        return None
    low, high = 0.0, grid.radius
    while high - low > _PRECISION:
        middle = (low + high) / 2
        low, high = (middle, high) if _joined(grid, places, middle) else (low, middle)
    return low


def _joined(grid: Grid, places: Points, radius: float) -> bool:
    areas = label(grid.walkable & (grid.clearance >= radius))
    rows, columns, _ = grid.cells(places)
    first, second = areas[rows, columns]
    return bool(first == second != 0)


def narrowest_place(grid: Grid, start: Points, goal: Points, radius: float) -> Points | None:
    """The place ``(2,)`` of least clearance on a way for an agent of ``radius``."""
    slim = replace(grid, radius=radius)
    roadmap = build_roadmap(slim, Penalty(2 * grid.radius, weight=20), factor=1)
    rows, columns, _ = slim.cells(np.stack([start, goal]))
    first, last = roadmap.node[rows, columns]
    route = cheapest_route(roadmap, int(first), int(last))
    if route is None:
        return None
    places = roadmap.points[route]
    return np.asarray(places[grid.clearance_at(places).argmin()])


def unreachable(grid: Grid, start: End, goal: End) -> PathError:
    """The error for two places in different connected areas."""
    said = f"the goal {spoken(goal.asked)} cannot be reached from the start {spoken(start.asked)}"
    radius = widest_way(grid, start.places[0], goal.places[0])
    if radius is None:
        return PathError(f"{said}: it lies in another room or on another floor, and no gap leads there")
    place = narrowest_place(grid, start.places[0], goal.places[0], radius)
    near = "" if place is None else f", near {spoken(place)},"
    needs = f"the agent needs {2 * grid.radius:.2f} m (a radius of {grid.radius:g} m)"
    return PathError(f"{said}: the narrowest place of the widest way{near} is {2 * radius:.2f} m wide, and {needs}")
