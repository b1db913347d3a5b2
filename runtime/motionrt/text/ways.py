"""How far and which way a text says that somebody turns and goes, as ranges."""

from __future__ import annotations

from dataclasses import dataclass

from motionrt.text.query import TextAttributes

Range = tuple[float, float]

_TURNS: dict[str, Range] = {"turn": (60, 125), "around": (150, 215), "full": (330, 400)}  # degrees
_BENDS: dict[str, Range] = {"curve": (70, 190), "circle": (240, 420), "spin": (330, 760)}
_STRAIGHT: Range = (-12, 12)
_PACES: dict[str | None, Range] = {  # m/s
    None: (0.45, 9.0), "slow": (0.3, 0.8), "walk": (0.75, 1.6), "jog": (1.5, 3.0), "run": (2.2, 6.0),
}  # fmt: skip
_BACKWARD, _SIDEWAYS = 0.4, 0.25  # least m/s
_STEP, _STAY = 0.35, 0.2  # metres of one step to a side; metres that whoever stays may drift
_SIDES = ("left", "right")
_ASIDE = 0.4  # metres aside for every metre of the way, at most


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
    low_high = turn if turn is None or side != "right" else (-turn[1], -turn[0])
    return Way(low_high, *_places(said, seconds), either=turn not in (None, _STRAIGHT) and side not in _SIDES)


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
    return None, None
