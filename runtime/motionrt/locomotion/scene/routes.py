"""Long walks through a scene, drawn at random: for tests and benchmarks."""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError, PathError
from motionrt.limits import limits
from motionrt.locomotion.path import Path
from motionrt.locomotion.scene.grid import BoolArray, Points
from motionrt.locomotion.scene.planner import Planner
from motionrt.untrusted.arguments import checked_whole, real
from motionrt.untrusted.words import shown

_TRIES = 6
_SHARP = np.cos(np.deg2rad(100))


def random_route(planner: Planner, length: float, seed: int) -> Path:
    """A path of ``length`` metres through random places of the largest connected area, the same for the same seed.

    Raises:
        PathError: nothing is free.
    """
    if not 0 < real(length) <= limits().metres:
        raise InvalidInputError(f"the length of a path must be a positive number of metres, not {shown(length)}")
    places = roomy_places(planner)
    random = np.random.default_rng(checked_whole(seed, "seed", 0))
    corners = places[random.integers(len(places))][None]
    while True:
        corners = np.concatenate([corners, _next_leg(planner, corners, places, random)[1:]])
        if np.linalg.norm(np.diff(corners, axis=0), axis=1).sum() > length + 3:
            path = Path(planner.rounded(corners).astype(np.float32))
            if path.length >= length:
                return path.part(0, length)


def roomy_places(planner: Planner) -> Points:
    """Cells ``(N, 2)`` of the largest connected area, those that keep comfortable clearance if there are any."""
    grid = planner.grid
    if not grid.free.any():
        raise PathError(f"nowhere in the scene is room for a radius of {grid.radius:g} m")
    largest: BoolArray = grid.areas == np.bincount(grid.areas[grid.areas > 0]).argmax()
    roomy = largest & (grid.clearance >= planner.penalty.comfort)
    return grid.centres(*np.nonzero(roomy if roomy.sum() > 100 else largest))


def _next_leg(planner: Planner, corners: Points, places: Points, random: np.random.Generator) -> Points:
    """A way to a random place: the first of a few that does not turn back sharply, else the one that turns least."""
    legs = []
    for _ in range(_TRIES):
        goal = places[random.integers(len(places))]
        if np.linalg.norm(goal - corners[-1]) < planner.grid.cell:
            continue
        legs.append(planner.leg(corners[-1], goal))
        if len(corners) < 2 or _onward(corners, legs[-1]) > _SHARP:
            return legs[-1]
    if not legs:
        raise PathError("the free ground is a single place: there is no path to draw")
    return max(legs, key=lambda leg: _onward(corners, leg))


def _onward(corners: Points, leg: Points) -> float:
    """Cosine of the turn from the last corner's way in to the first way of a leg."""
    if len(corners) < 2:
        return 1.0
    way_in, way_out = corners[-1] - corners[-2], leg[1] - leg[0]
    return float(way_in @ way_out / (np.linalg.norm(way_in) * np.linalg.norm(way_out)))
