"""How far and which way a text says that somebody turns and goes, as ranges; how high the pelvis is in time."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.text.query import TextAttributes

Range = tuple[float, float]

_TURNS: dict[str, Range] = {"turn": (60, 125), "around": (150, 215), "full": (330, 400)}  # degrees
_BENDS: dict[str, Range] = {"curve": (70, 190), "circle": (240, 420), "spin": (330, 760)}
_STRAIGHT: Range = (-12, 12)
_PACES: dict[str | None, Range] = {  # m/s
    None: (0.45, 9.0), "slow": (0.3, 0.8), "walk": (0.75, 1.6), "jog": (1.5, 3.0), "run": (2.2, 6.0),
}  # fmt: skip
_BACKWARD, _SIDEWAYS, _STAIRS = 0.4, 0.25, 0.3  # least m/s
_STEP, _STAY = 0.35, 0.2  # metres of one step to a side; metres that whoever stays may drift
_SIDES = ("left", "right")
_ASIDE = 0.4  # metres aside for every metre of the way, at most
_HEIGHTS = {  # of the pelvis of smpl24, metres; medians of recordings
    "standing": 0.94, "crouching": 0.58, "sitting": 0.5, "crawling": 0.45, "kneeling": 0.44, "lying": 0.09,
}  # fmt: skip
_FLOOR = re.compile(r"\b(?:floor|ground)\b")
_LEAST_CHANGE, _OVER = 0.2, 0.1  # metres
_FIRST, _LAST, _LATEST_S = 0.4, 0.7, 2.0  # when it changes: parts of the motion, seconds at most for the first
_CHANGE_S = 0.2  # of the logistic curve of a change, which lasts about six times as long


@dataclass(frozen=True)
class Way:
    """Ranges of what a whole motion does; None where a text leaves it open.

    Attributes:
        turn: net turn, degrees, left positive; of either side where `either`.
        forward, left: net way in the axes of the first frame, metres.
    """

    turn: Range | None = None
    forward: Range | None = None
    left: Range | None = None
    either: bool = False


def way_of_text(said: TextAttributes, seconds: float) -> Way:
    """What a text says of the way of a motion of so many seconds."""
    turn, side = _turning(said)
    sided = (-turn[1], -turn[0]) if turn is not None and side == "right" else turn
    return Way(sided, *_places(said, seconds), either=turn not in (None, _STRAIGHT) and side not in _SIDES)


def _turning(said: TextAttributes) -> tuple[Range | None, str | None]:
    """How far it turns, and to which side; a bent path turns who walks it."""
    if said.turn == "none" or said.path == "straight":
        return _STRAIGHT, None
    if said.path is not None:
        return _BENDS.get(said.path), said.path_side
    return (_TURNS.get(said.turn), said.turn_side) if said.turn else (None, None)


def _places(said: TextAttributes, seconds: float) -> tuple[Range | None, Range | None]:
    if said.travel == "none":
        return (-_STAY, _STAY), (-_STAY, _STAY)
    if said.travel in ("left", "right"):
        low = min(_SIDEWAYS * seconds, _STEP) if said.action != "sidestep" else _SIDEWAYS * seconds
        far = (low, 9.0) if said.travel == "left" else (-9.0, -low)
        return (-_ASIDE * low, _ASIDE * low), far
    if said.travel == "backward":
        low = _BACKWARD * seconds
        return (-9.0, -low), (-_ASIDE * low, _ASIDE * low)
    if said.travel == "forward" and said.path in (None, "straight") and said.turn in (None, "none"):
        low, high = _PACES.get(said.speed, _PACES[None])
        return (low * seconds, high * seconds), (-_ASIDE * low * seconds, _ASIDE * low * seconds)
    return ((_STAIRS * seconds, 9.0), None) if said.action == "stairs" and said.travel is None else (None, None)


def heights_of_text(said: TextAttributes, times: npt.ArrayLike) -> FloatArray | None:
    """Heights ``(F,)`` of the pelvis of ``smpl24``, metres, at times ``(F,)`` in seconds, of texts that go down or up.

    None where the text stays at a level, moves on as well, or does not say how high it is.
    """
    moves_on = said.travel not in (None, "none") or said.turn not in (None, "none") or said.path or said.jumps
    course = None if moves_on else _course(said)
    if course is None:
        return None
    start, middle, end = course
    at = np.asarray(times, np.float64)
    seconds = float(at[-1])
    once = middle is None
    first = min((_FIRST if once else 1 - _LAST) * seconds, _LATEST_S)
    heights = start + ((end if middle is None else middle) - start) * _changed(at - first)
    if middle is not None:
        heights = heights + (end - middle) * _changed(at - _LAST * seconds)
    return np.asarray(heights, np.float32)


def ceiling_of_text(said: TextAttributes) -> float | None:
    """Metres below which the pelvis of ``smpl24`` stays in a text of one low posture; None elsewhere."""
    low = said.posture_lowest
    stays = low is not None and low == said.posture_start == said.posture_end and said.level in (None, "level")
    height = _HEIGHTS.get(low or "", _HEIGHTS["standing"])
    return height + _OVER if stays and height < _HEIGHTS["standing"] else None


def _changed(times: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(1 / (1 + np.exp(-times / _CHANGE_S)))


def _course(said: TextAttributes) -> tuple[float, float | None, float] | None:
    """Heights at the start, in the middle where it is another one, and at the end."""
    up = _HEIGHTS["standing"]
    start, end = (_HEIGHTS.get(name or "") for name in (said.posture_start, said.posture_end))
    lowest = _HEIGHTS.get(said.posture_lowest or "")
    middle = None
    if said.level == "up":
        risen_from = 0.3 if _FLOOR.search(said.text) else _HEIGHTS["sitting"]
        start, end = next(height for height in (start, lowest, risen_from) if height is not None), up
    elif said.level == "down":
        start, end = up, lowest if end is None else end
    elif said.level == "down and up" or (start in (None, up) and end == up and lowest is not None):
        start, middle, end = up, lowest, up
    if start is None or end is None:
        return None
    changes = max(start, end) - min(start, end, end if middle is None else middle)
    return (start, middle, end) if changes >= _LEAST_CHANGE else None
