"""Corners of a polyline turned into arcs that a walking human can follow."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]
Allowed = Callable[[Points], bool]
"""Whether a piece of path may replace a corner."""

_ARC_STEP = np.deg2rad(6)
_LEAST_TURN = 0.4  # metres: a radius that a walking human turns with
_MOST_CUT = 0.45  # metres by which an arc may miss its corner for the sake of more than that


def round_corners(points: npt.ArrayLike, tries: Sequence[tuple[float, Allowed]]) -> Points:
    """``points`` ``(N, 2)`` with every corner replaced by the first arc that is allowed, ``(M, 2)``; ends stay.

    Args:
        points: the corners.
        tries: radii in metres with the judge of their arcs, best first. Where the legs beside a corner are too short
            for a radius, the arc is as large as they admit; a corner for which no arc is allowed stays as it is.
            Arcs of sharp turns get smaller, down to a radius of 0.4 m, to miss the corner by less than half a metre.
    """
    corners = np.asarray(points, dtype=np.float64)
    steps = np.diff(corners, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    ways = steps / lengths[:, None]
    half_tangents = np.tan(_turns(ways) / 2)
    arcs = [corners[i : i + 1] for i in range(len(corners))]
    done = half_tangents < 1e-4
    beyond = np.sqrt(1 + half_tangents**2) - 1  # how far a corner lies outside its arc, in radii
    near = np.maximum(_LEAST_TURN, _MOST_CUT / np.maximum(beyond, 1e-9))
    taken = np.zeros(len(lengths))  # metres of every leg that arcs have used up, the same share for both ends
    for radius, allowed in tries:
        for i in np.flatnonzero(~done):
            reach = _reach(np.minimum(radius, near) * half_tangents, taken, lengths, done, int(i))
            arc = _arc(corners[i + 1], ways[i], ways[i + 1], reach)
            if reach > 1e-3 and allowed(arc):
                arcs[i + 1], done[i] = arc, True
                taken[i : i + 2] += reach
    return np.concatenate(arcs)


def _turns(ways: Points) -> Points:
    """Angle in radians between successive unit directions; a full reversal is kept a little below pi."""
    return np.asarray(np.minimum(np.arccos(np.clip((ways[:-1] * ways[1:]).sum(axis=1), -1, 1)), np.pi - 0.01))


def _reach(wanted: Points, taken: Points, lengths: Points, done: npt.NDArray[np.bool_], i: int) -> float:
    """How far from corner ``i`` its arc may begin: what it wants, or its share of what its legs have left."""
    reach = float(wanted[i])
    for leg, neighbour in ((i, i - 1), (i + 1, i + 1)):
        rival = wanted[neighbour] if 0 <= neighbour < len(wanted) and not done[neighbour] else 0.0
        reach = min(reach, (lengths[leg] - taken[leg]) * wanted[i] / (wanted[i] + rival))
    return reach


def _arc(corner: Points, way_in: Points, way_out: Points, reach: float) -> Points:
    """The circular arc that leaves ``way_in`` and joins ``way_out`` at ``reach`` metres from the corner, ``(K, 2)``."""
    side = np.sign(way_in[0] * way_out[1] - way_in[1] * way_out[0]) or 1.0
    normal = side * np.array([-way_in[1], way_in[0]])
    turn = float(_turns(np.stack([way_in, way_out]))[0])
    radius = reach / np.tan(turn / 2)
    angles = np.linspace(0, turn, max(3, int(np.ceil(turn / _ARC_STEP)) + 1))[:, None]
    start = corner - way_in * reach
    return np.asarray(start + radius * (np.sin(angles) * way_in + (1 - np.cos(angles)) * normal))
