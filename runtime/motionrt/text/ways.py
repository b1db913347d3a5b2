"""How far and which way a text says that somebody turns and goes, as ranges."""

from __future__ import annotations

import re
from dataclasses import dataclass

from motionrt.text.query import TextAttributes

Range = tuple[float, float]

_TURNS: dict[str, Range] = {"turn": (60, 125), "around": (150, 215), "full": (330, 400)}  # degrees
_BENDS: dict[str, Range] = {"curve": (70, 190), "circle": (240, 420), "spin": (330, 760)}
_SLIGHTLY: Range = (20, 60)
_VEERING: Range = (50, 95)
_STRAIGHT: Range = (-12, 12)
_FACING: Range = (-20, 20)  # of who goes aside or backward
_SPINS_S = 0.9  # seconds of one turn of somebody who spins several times, at least
_PACES: dict[str | None, Range] = {  # m/s
    None: (0.45, 9.0), "slow": (0.3, 0.8), "walk": (0.75, 1.6), "jog": (1.5, 3.0), "run": (2.2, 6.0),
}  # fmt: skip
_BRISK: Range = (1.2, 2.2)  # m/s of who walks fast
_BACKWARD, _SIDEWAYS, _STAIRS = 0.4, 0.25, 0.3  # least m/s
_STEP, _STAY, _NEAR = 0.35, 0.2, 0.4  # metres of one step to a side; that whoever stays may drift, and stray
_SIDES = ("left", "right")
_ASIDE = 0.4  # metres aside for every metre of the way, at most
_SLIGHT = re.compile(r"\b(?:slight\w*|a (?:bit|little)|gentl[ey]|gradual\w*|drift\w*)\b")
_DEGREES = re.compile(r"\b([1-9]\d{1,2}) ?(?:degs?\b|degrees?\b|\u00b0)", re.IGNORECASE)
_VEER = re.compile(r"\b(?:veer|swerv|bear|bank)\w*")
_FASTEST_ASIDE, _FASTEST_BACK, _FASTEST_BEND = 0.8, 0.95, 1.5  # m/s of who does not run
_FAST = frozenset({"jog", "run"})


@dataclass(frozen=True)
class Way:
    """Ranges of what a whole motion does; None where a text leaves it open.

    Attributes:
        turn: net turn, degrees, left positive; of either side where `either`.
        forward, left: net way in the axes of the first frame, metres.
        near: metres from its start that it stays within, all the way.
        length: of the way over the ground, metres, at least and at most.
    """

    turn: Range | None = None
    forward: Range | None = None
    left: Range | None = None
    length: Range | None = None
    either: bool = False
    near: float | None = None


def way_of_text(said: TextAttributes, seconds: float) -> Way:
    """What a text says of the way of a motion of so many seconds."""
    turn, side = _turning(said, seconds)
    sided = (-turn[1], -turn[0]) if turn is not None and side == "right" else turn
    return Way(
        sided,
        *_places(said, seconds),
        _length(said, seconds),
        either=turn not in (None, _STRAIGHT, _FACING) and side not in _SIDES,
        near=_NEAR if said.travel == "none" else None,
    )


def _turning(said: TextAttributes, seconds: float) -> tuple[Range | None, str | None]:
    """How far it turns, and to which side; a bent path turns who walks it."""
    if said.turn == "none" or said.path == "straight":
        return _STRAIGHT, None
    exact = _exactly(said)
    if exact is not None:
        return exact, said.path_side if said.path else said.turn_side
    if said.path == "spin" and (said.repeats or 0) > 1:
        count = min(said.repeats or 1, max(1, int(seconds / _SPINS_S)))
        return (350.0 * count, 410.0 * count), said.path_side
    if said.path is not None:
        return _BENDS.get(said.path), said.path_side
    if said.turn:
        return _TURNS.get(said.turn), said.turn_side
    return (_FACING if said.travel in ("left", "right", "sideways", "backward") and said.course is None else None), None


def _exactly(said: TextAttributes) -> Range | None:
    """How far somebody turns of whose turn the text says that it is small, or how many degrees it has."""
    degrees = _DEGREES.search(said.text)
    if degrees and said.turn in ("turn", "around") and said.path is None:
        return 0.9 * float(degrees[1]), 1.1 * float(degrees[1])
    if said.path == "curve" or (said.path is None and said.turn == "turn"):
        return _SLIGHTLY if _SLIGHT.search(said.text) else _VEERING if _VEER.search(said.text) else None
    return None


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
    if (
        said.course is None
        and said.travel == "forward"
        and said.path in (None, "straight")
        and said.turn in (None, "none")
    ):
        brisk = said.pace == "fast" and said.speed is None and said.action == "walk"
        low, high = _BRISK if brisk else _PACES.get(said.speed, _PACES[None])
        return (low * seconds, high * seconds), (-_ASIDE * low * seconds, _ASIDE * low * seconds)
    return ((_STAIRS * seconds, 9.0), None) if said.action == "stairs" and said.travel is None else (None, None)


def _length(said: TextAttributes, seconds: float) -> Range | None:
    """How long the way of somebody is who goes aside, backward or along a bend."""
    if said.travel in ("left", "right", "sideways") and said.speed not in _FAST and not said.jumps:
        return 0.0, _FASTEST_ASIDE * seconds
    if said.travel == "backward" and not said.jumps:
        return 0.0, (_PACES["jog"][1] if said.speed in _FAST else _FASTEST_BACK) * seconds
    bent = said.course is not None or said.path in ("curve", "circle")
    if not bent or said.action in ("dance", "swim"):
        return None
    low, high = _PACES.get(said.speed, _PACES[None])
    high = high if said.speed in _FAST else _FASTEST_BEND
    return low * seconds if said.travel == "forward" else 0.0, high * seconds
