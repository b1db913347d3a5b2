"""Where on a thing one lies: its surface, its long sides, the end with the pillow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.locomotion.lying import STEP_AWAY
from motionrt.locomotion.words.footprint import Side, sides
from motionrt.locomotion.words.seats import rim_height, seat_height, seat_surface
from motionrt.locomotion.words.things import Thing

SHORTEST = 1.5  # metres of a surface to lie on
HEAD_TO_PELVIS = 0.92  # metres from the head's end of the surface to the pelvis
HIGHER = 0.1  # metres that one end has to be higher than the other to be the head's
BESIDE = 0.35  # metres from the pelvis to the edge, at most: nobody lies down in the middle of a wide bed first


@dataclass(frozen=True)
class Bed:
    """Where to lie.

    Attributes:
        at: (x, y, z) metres of the surface where the pelvis lies.
        edge: (x, z) of the edge to sit down on.
        heading: radians from +Z towards +X that the feet point to.
    """

    at: tuple[float, float, float]
    edge: tuple[float, float]
    heading: float


def find_bed(thing: Thing) -> Bed:
    """Where to lie on a thing, and the long side to get there from: the free one, or the nearer of two.

    Raises:
        InvalidInputError: no surface between 25 and 75 cm above the ground is long enough.
    """
    height = seat_height(thing.points, thing.around.floor, "lie")
    around = sides(seat_surface(thing.points, height))
    long = around[0].width < around[1].width
    ends, edges = (around[0::2], around[1::2]) if long else (around[1::2], around[0::2])
    length, width = ends[0].depth, edges[0].depth
    if length < SHORTEST:
        raise InvalidInputError(
            f"the {thing.label} is {length:.2f} m long; to lie down takes a surface of at least {SHORTEST:g} m"
        )
    head = _head(thing, height, ends)
    edge = min(edges, key=lambda side: _cost(side, thing))
    inside = min(width / 2, BESIDE)
    # from the head's end to where the pelvis lies, along the edge
    middle = head.at(0.0, -min(HEAD_TO_PELVIS, length / 2))
    across = float((middle - edge.centre) @ edge.along)
    place, rim = edge.at(across, -inside), edge.at(across, 0.0)
    return Bed(
        (float(place[0]), float(height), float(place[1])),
        (float(rim[0]), float(rim[1])),
        float(np.arctan2(-head.normal[0], -head.normal[1])),
    )


def _head(thing: Thing, height: float, ends: tuple[Side, ...]) -> Side:
    """The end with a headboard or pillows; of two alike, that with less free ground before it."""
    high = [rim_height(thing.points, height, end) for end in ends]
    if abs(high[0] - high[1]) > HIGHER:
        return ends[int(np.argmax(high))]
    return max(ends, key=lambda end: thing.around.blocked(end.at(0.0, STEP_AWAY)))


def _cost(side: Side, thing: Thing) -> float:
    """Of sitting down on a side: nothing in the way, ground under the feet, near."""
    place = side.at(0.0, STEP_AWAY)
    barred = thing.around.blocked(place) > 0 or not thing.around.grounded(place)
    return 10.0 * barred + float(np.linalg.norm(place - thing.around.near))
