"""Where on a thing one sits: the height of its seat, its front, its edge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.locomotion.words.footprint import Plan, Side, plan
from motionrt.motion.skeleton import FloatArray

LOWEST, HIGHEST = 0.25, 0.75  # metres that a seat may be above the ground
_CELL = 0.08  # metres; coverage is counted in squares of this size, so that the density of points means nothing
_THICKNESS = 0.03  # of a seat's surface, up and down
_LEAST_AREA = 0.06  # square metres
_BACKREST = 0.15  # metres above the seat at which a backrest or an armrest begins
_RIM = 0.20  # metres of a side's rim in which its backrest or armrest stands
_SIDEWAYS = 0.30  # metres that somebody who sits needs to each side


@dataclass(frozen=True)
class Seat:
    """Where to sit.

    Attributes:
        height: metres, world.
        side: the side that one faces away from.
        across: metres along ``side``.
        front, back: metres behind ``side`` at which the seat begins and ends there.
    """

    height: float
    side: Side
    across: float
    front: float
    back: float


def find_seat(points: FloatArray, floor: float, front: Side, near: Plan | None) -> Seat:
    """The place on the seat of ``points`` ``(N, 3)`` that is nearest to ``near``, else the middle."""
    height = seat_height(points, floor)
    surface = seat_surface(points, height)
    low, high = np.percentile(front.across(surface), [2.0, 98.0])
    room = min(_SIDEWAYS, (high - low) / 2)
    wanted = (low + high) / 2 if near is None else float((near - front.centre) @ front.along)
    across = float(np.clip(wanted, low + room, high - room))
    there = np.abs(front.across(surface) - across) < 0.2
    edge, back = np.percentile(front.inside(surface[there] if there.any() else surface), [3.0, 97.0])
    return Seat(height, front, across, float(edge), float(back))


def seat_height(points: FloatArray, floor: float, verb: str = "sit") -> float:
    """World height of the level between 25 and 75 cm that covers most of the ground plan.

    Raises:
        InvalidInputError: no such level is large enough to sit on; ``verb`` says what for.
    """
    heights = points[:, 1] - floor
    levels = np.arange(LOWEST, HIGHEST + 1e-6, 0.01)
    covered = [_area(points[np.abs(heights - level) <= _THICKNESS]) for level in levels]
    most = max(covered)
    if most < _LEAST_AREA:
        raise InvalidInputError(
            f"nothing to {verb} on: no surface between {100 * LOWEST:.0f} and {100 * HIGHEST:.0f} cm above the ground"
        )
    level = float(np.mean(levels[np.array(covered) >= 0.97 * most]))
    return float(np.median(points[np.abs(heights - level) <= _THICKNESS, 1]))


def seat_surface(points: FloatArray, height: float) -> FloatArray:
    """The points ``(n, 3)`` of a seat that have nothing above them."""
    above = {tuple(cell) for cell in _cells(points[points[:, 1] > height + _BACKREST - _THICKNESS]).tolist()}
    surface = points[np.abs(points[:, 1] - height) <= _THICKNESS]
    open_ = np.array([tuple(cell) not in above for cell in _cells(surface).tolist()], dtype=bool)
    return np.asarray(surface[open_]) if open_.any() else surface


def backrest_front(points: FloatArray, height: float, around: Sequence[Side]) -> Side | None:
    """The side opposite to the backrest, or None for a seat without one."""
    walls = [rim_height(points, height, side) for side in around]
    openness = [walls[(i + 2) % 4] - walls[i] for i in range(4)]
    best = int(np.argmax(openness))
    return around[best] if openness[best] > 0.1 else None


def rim_height(points: FloatArray, height: float, side: Side) -> float:
    """Mean height above the seat, metres, of what stands along the rim of a side."""
    rim = points[(side.inside(points) < min(_RIM, side.depth / 3)) & (points[:, 1] > height + _BACKREST)]
    columns = max(1, int(side.width / _CELL))
    column = np.clip(((side.across(rim) / side.width + 0.5) * columns).astype(int), 0, columns - 1)
    tops = np.zeros(columns)
    np.maximum.at(tops, column, np.minimum(rim[:, 1] - height, 0.8))
    return float(tops.mean())


def _cells(points: FloatArray) -> np.ndarray:
    return np.floor(plan(points) / _CELL).astype(np.int64)


def _area(points: FloatArray) -> float:
    return len(np.unique(_cells(points), axis=0)) * _CELL**2
