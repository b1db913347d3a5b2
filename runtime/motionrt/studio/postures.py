"""One click, a whole pose: where feet, pelvis and hands go when somebody sits down or grabs something there."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from motionrt.locomotion import Act
from motionrt.locomotion.bearings import ahead_of
from motionrt.motion.transforms import TOE_JOINTS

Place = tuple[float, float]
Point = tuple[float, float, float]
Free = Callable[[Place], bool]

GROUND = 0.1  # metres; clicks below met the ground and not a thing
PELVIS_ABOVE_SEAT, KNEES_AHEAD, APPROACH_AHEAD = 0.13, 0.50, 0.62  # metres, of somebody who sits
ARM, STANCE = (0.48, 0.42, 0.55, 0.62), 0.12  # metres from the feet to what a hand grabs; half the width of the stance
_TURNS = tuple(math.radians(side * step) for step in range(0, 181, 15) for side in ((1, -1) if step else (1,)))


def sit(point: Point, before: Place, seat: float, hold_s: float, free: Free | None = None) -> Act:
    """Sit down at a point (x, y, z), facing where the character comes from, or the next free side.

    Args:
        point: of the seat; on the ground it is a seat of height ``seat`` metres.
        before: where the character comes from.
        seat: metres.
        hold_s: seconds to stay.
        free: whether somebody can stand at a place.
    """
    place = (point[0], point[2])
    facing = _free_side(place, heading(place, before), (APPROACH_AHEAD,), free)[0]
    height = (point[1] if point[1] > GROUND else seat) + PELVIS_ABOVE_SEAT
    feet = _feet(ahead_of(place, facing, KNEES_AHEAD), facing)
    keypoints = {"pelvis": _rounded((place[0], height, place[1])), **feet}
    approach = ahead_of(place, facing, APPROACH_AHEAD)
    return Act(keypoints, facing, hold_s, (round(approach[0], 3), round(approach[1], 3)), "sit")


def grab(point: Point, before: Place, side: str, height: float, hold_s: float, free: Free | None = None) -> Act:
    """Stand before a point (x, y, z) and put a hand there; on the ground ``height`` metres above it."""
    place = (point[0], point[2])
    back, away = _free_side(place, heading(place, before), ARM, free)
    facing = _wrapped(back + math.pi)
    feet = _feet(ahead_of(place, back, away), facing)
    hand = (point[0], point[1] if point[1] > GROUND else height, point[2])
    return Act({f"{side}_hand": _rounded(hand), **feet}, facing, hold_s, None, f"grab at {hand[1]:.2f} m")


def foothold(keypoints: Mapping[str, Sequence[float]]) -> Place:
    """Where a pose stands: (x, z) between its feet, or of all its keypoints."""
    feet = [keypoints[joint] for joint in TOE_JOINTS if joint in keypoints]
    x, _, z = np.mean(feet or list(keypoints.values()), axis=0)
    return float(x), float(z)


def heading(a: Place, b: Place) -> float:
    """From one place to another, radians from +Z towards +X; 0 where they are the same."""
    return math.atan2(b[0] - a[0], b[1] - a[1]) if a != b else 0.0


def _free_side(place: Place, wanted: float, distances: Sequence[float], free: Free | None) -> tuple[float, float]:
    """Direction and distance from a place at which somebody can stand, the direction as near ``wanted`` as can be."""
    for turn in _TURNS:
        for distance in distances:
            if free is None or free(ahead_of(place, wanted + turn, distance)):
                return _wrapped(wanted + turn), distance
    return _wrapped(wanted), distances[0]


def _feet(place: Place, facing: float) -> dict[str, Point]:
    """The balls of both feet side by side; who faces +Z has the left one towards +X."""
    out: dict[str, Point] = {}
    for joint, side in (("left_foot", 1), ("right_foot", -1)):
        x, z = ahead_of(place, facing + side * math.pi / 2, STANCE)
        out[joint] = _rounded((x, 0.0, z))
    return out


def _rounded(point: Point) -> Point:
    """To a millimetre, as scripts are read by people."""
    return round(point[0], 3), round(point[1], 3), round(point[2], 3)


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2 * math.pi)
