"""Where a path begins and ends: places that the agent can stand in, near those that were asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, PathError
from motionrt.locomotion.scene.grid import Grid, IntArray, Points
from motionrt.locomotion.scene.tracing import straight_open
from motionrt.untrusted.arguments import checked_array
from motionrt.untrusted.words import shown


@dataclass(frozen=True)
class End:
    """The start or the goal of a path.

    Attributes:
        name: "start" or "goal", for messages.
        asked: ``(2,)`` the place that was asked for, (x, z) metres.
        exact: whether the path can go there: it is ground without obstacles.
        places: ``(K, 2)`` free places near it, nearest first; itself if it is free.
        areas: ``(K,)`` the connected free areas that they lie in.
    """

    name: str
    asked: Points
    exact: bool
    places: Points
    areas: IntArray

    def in_area(self, area: int) -> Points:
        """The nearest free place ``(2,)`` in a connected area."""
        return np.asarray(self.places[np.argmax(self.areas == area)])

    def note(self, place: Points) -> str | None:
        """What to tell if the path turns to ``place`` instead of what was asked for."""
        away = float(np.linalg.norm(place - self.asked))
        if away < 1e-6:
            return None
        if self.exact:
            return f"the {self.name} is close to an obstacle: {away:.2f} m of the path there keep less than the radius"
        return f"the {self.name} is in an obstacle: moved {away:.2f} m to {spoken(place)}"


def find_end(grid: Grid, xz: npt.ArrayLike, name: str, snap: float) -> End:
    """Free places at ``xz`` or at most ``snap`` metres from it; from open ground only those straight ahead.

    Raises:
        PathError: the place lies outside the scene, or in an obstacle with nothing free so near.
        InvalidInputError: ``xz`` is not two finite numbers.
    """
    asked = checked_array(xz, f"the {name}", "two finite numbers, x and z in metres")
    if asked.shape != (2,) or not np.isfinite(asked).all():
        raise InvalidInputError(f"the {name} must be two finite numbers, x and z in metres, not {shown(xz)}")
    row, column, inside = grid.cells(asked)
    if not inside:
        low, high = grid.origin, grid.origin + np.array(grid.shape[::-1]) * grid.cell
        raise PathError(f"the {name} {spoken(asked)} is outside the scene, {spoken(low)} to {spoken(high)}")
    if grid.free[row, column]:
        return End(name, asked, True, asked[None], np.array([grid.areas[row, column]]))
    exact = bool(grid.walkable[row, column])
    rows, columns = np.nonzero(grid.free)
    places = grid.centres(rows, columns)
    away = np.linalg.norm(places - asked, axis=1)
    near = np.flatnonzero(away <= snap)
    near = near[np.argsort(away[near], kind="stable")]
    if exact:
        near = near[straight_open(grid, np.repeat(asked[None], len(near), axis=0), places[near], least=1e-6)]
    if not len(near):
        raise PathError(_in_obstacle(name, asked, exact, places, away, snap, grid))
    return End(name, asked, exact, places[near], grid.areas[rows[near], columns[near]].astype(np.int64))


def spoken(xz: Points) -> str:
    """A place for a message."""
    return f"({xz[0]:.2f}, {xz[1]:.2f})"


def _in_obstacle(name: str, asked: Points, exact: bool, places: Points, away: Points, snap: float, grid: Grid) -> str:
    where = f"closer than {grid.radius:g} m to obstacles" if exact else "in an obstacle or off the ground"
    said = f"the {name} {spoken(asked)} is {where}"
    if not len(places):
        return f"{said}, and nowhere in the scene is room for a radius of {grid.radius:g} m"
    nearest = int(away.argmin())
    return (
        f"{said}; the next free ground is at {spoken(places[nearest])}, {away[nearest]:.2f} m away (snap is {snap:g} m)"
    )
