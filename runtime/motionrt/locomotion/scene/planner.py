"""Paths through a grid: A*, shortcuts, round corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from motionrt.errors import PathError
from motionrt.locomotion.corners import round_corners
from motionrt.locomotion.path import Path
from motionrt.locomotion.scene.blocking import unreachable
from motionrt.locomotion.scene.ends import End, find_end, spoken
from motionrt.locomotion.scene.grid import Grid, Points
from motionrt.locomotion.scene.penalty import Penalty
from motionrt.locomotion.scene.roadmap import Roadmap, build_roadmap
from motionrt.locomotion.scene.search import cheapest_route
from motionrt.locomotion.scene.straighten import straightened
from motionrt.locomotion.scene.tracing import straight_open

_BLOCK = 0.1  # metres: finer grids are searched in blocks of about this size
_MOST_NODES = 250_000
_WIDE_TURNS, _TIGHT_TURNS = (1.2, 0.8, 0.5), (0.4, 0.2, 0.1)  # metres: where there is room, and where there is little


@dataclass(frozen=True, eq=False)
class Planner:
    """Plans on one grid; what a search needs is built at the first one and kept.

    Attributes:
        grid: the ground.
        penalty: the cost of walking close to obstacles.
    """

    grid: Grid
    penalty: Penalty

    @cached_property
    def roadmap(self) -> Roadmap:
        """Where routes are searched: in blocks of 10 cm, larger in very large scenes."""
        block = max(1, round(_BLOCK / self.grid.cell))
        crowd = float(self.grid.free.sum()) / block**2 / _MOST_NODES
        return build_roadmap(self.grid, self.penalty, int(np.ceil(block * max(1.0, crowd) ** 0.5)))

    @cached_property
    def every_cell(self) -> Roadmap:
        """Where a route is searched that winds through gaps too narrow for blocks."""
        return build_roadmap(self.grid, self.penalty, 1)

    def plan(self, stops: Sequence[npt.ArrayLike], snap: float) -> Path:
        """A path through places (x, z) in this order; round corners may miss those between by a little."""
        names = ["start", *[f"stop {i}" for i in range(1, len(stops) - 1)], "goal"]
        ends = [find_end(self.grid, stop, name, snap) for name, stop in zip(names, stops, strict=True)]
        places = self._places(ends)
        legs = [self.leg(a, b) for a, b in pairwise(places) if np.linalg.norm(b - a) > 1e-6]
        notes = tuple(filter(None, (end.note(place) for end, place in zip(ends, places, strict=True))))
        before = [end.asked[None] for end in ends[:1] if end.exact]
        after = [end.asked[None] for end in ends[-1:] if end.exact]
        return Path(_float32(self.rounded(_joined([*before, *legs, *after], ends))), notes)

    def _places(self, ends: list[End]) -> Points:
        """A free place for each end, all in one connected area, that with the shortest ways to the ends."""
        shared = set.intersection(*(set(end.areas.tolist()) for end in ends))
        if not shared:
            first = next(
                i for i in range(1, len(ends)) if not set(ends[0].areas.tolist()) & set(ends[i].areas.tolist())
            )
            raise unreachable(self.grid, ends[0], ends[first])
        choices = [np.stack([end.in_area(area) for end in ends]) for area in sorted(shared)]
        asked = np.stack([end.asked for end in ends])
        return min(choices, key=lambda places: float(np.linalg.norm(places - asked, axis=1).sum()))

    def leg(self, start: Points, goal: Points) -> Points:
        """Corners ``(N, 2)`` of a way between free places of one area."""
        route = self._route(self.roadmap, start, goal)
        if route is None and self.roadmap.factor > 1:
            route = self._route(self.every_cell, start, goal)
        if route is None:
            raise PathError(f"found no way from {spoken(start)} to {spoken(goal)}")
        return straightened(np.concatenate([start[None], route, goal[None]]), self.grid, self.penalty)

    def _route(self, roadmap: Roadmap, start: Points, goal: Points) -> Points | None:
        first, last = (self._entry(roadmap, place) for place in (start, goal))
        if first is None or last is None:
            return None
        route = cheapest_route(roadmap, first, last)
        return None if route is None else roadmap.points[route]

    def _entry(self, roadmap: Roadmap, place: Points) -> int | None:
        """The nearest node that a straight way leads to."""
        row, column, _ = self.grid.cells(place)
        r, c = int(row) // roadmap.factor, int(column) // roadmap.factor
        nodes = roadmap.node[max(0, r - 1) : r + 2, max(0, c - 1) : c + 2].ravel()
        nodes = nodes[nodes >= 0]
        away = np.linalg.norm(roadmap.points[nodes] - place, axis=1)
        for node in nodes[np.argsort(away, kind="stable")]:
            if straight_open(self.grid, place[None], roadmap.points[node][None])[0]:
                return int(node)
        return None

    def rounded(self, corners: Points) -> Points:
        """Corners turned into arcs: wide where they keep room, tight where they are only free."""
        wide = [(radius, self._roomy) for radius in _WIDE_TURNS]
        return round_corners(corners, [*wide, *((radius, self._free) for radius in _TIGHT_TURNS)])

    def _roomy(self, arc: Points) -> bool:
        wanted = (self.grid.radius + max(self.penalty.comfort, self.grid.radius)) / 2
        return bool(straight_open(self.grid, arc[:-1], arc[1:], wanted).all())

    def _free(self, arc: Points) -> bool:
        return bool(straight_open(self.grid, arc[:-1], arc[1:]).all())


def _joined(parts: list[Points], ends: list[End]) -> Points:
    """One polyline without repeated points."""
    points = np.concatenate(parts) if parts else np.empty((0, 2))
    if len(points):
        points = points[np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6)]
    if len(points) < 2:
        raise PathError(f"the start {spoken(ends[0].asked)} and the goal are the same place: there is no way to walk")
    return points


def _float32(points: Points) -> npt.NDArray[np.float32]:
    return points.astype(np.float32)
