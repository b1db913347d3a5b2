"""Turns, paths, travel and speed in a text."""

from __future__ import annotations

from typing import Any

from motionrt.text import lexicon as lex
from motionrt.text.patterns import first, has, matches, only, sides, without

Found = dict[str, Any]
_QUIET = frozenset({"stand", "sit", "lie", "kneel", "squat", "imitate"})


def turn_of(words: str, _found: Found) -> Found:
    """``turn`` and ``turn_side``; of several turns only what all agree on."""
    text = without(words, [lex.NOT_PATHS])
    side = _turn_side(text)
    kind = first(text, lex.TURNS)
    if kind is None and has(text, lex.NO_TURN) and side is None:
        return {"turn": "none", "turn_side": None}
    if kind is None and side and has(text, lex.TURN_VERBS):
        kind = "turn"
    if len(matches(text, lex.TURN_WORDS)) > 1 and has(text, lex.SEVERAL_PARTS):
        kind = None
    return {"turn": kind, "turn_side": side}


def _turn_side(text: str) -> str | None:
    clock = {side for side, pattern in ((s, p) for p, s in lex.CLOCKWISE) if has(text, pattern)}
    if clock:
        return only(clock)
    if has(text, lex.BOTH_SIDES):
        return None
    return only(sides(text, lex.TURN_SIDE))


def path_of(words: str, found: Found) -> Found:
    """``path`` and ``path_side``; a spin or circle leaves the amount of the turn open."""
    text = without(words, [lex.NOT_PATHS])
    side, goes = found["turn_side"], has(text, lex.GOES)
    course = first(text, lex.COURSES)
    if course:
        return {"course": course, "turn": None, "turn_side": None}
    if has(text, lex.SPINS) and found["turn"] != "around":
        return {"path": "spin", "path_side": side, "turn": "full" if found["turn"] == "full" else None}
    if has(text, lex.CIRCLES) and found["turn"] != "around":
        on_spot = found["turn"] == "full" and not goes
        return {"path": "spin" if on_spot else "circle", "path_side": side, "turn": None}
    if has(text, lex.CURVES):
        around = found["turn"] if found["turn"] == "around" else None
        return {"path": "curve", "path_side": side, "turn": around}
    if found["turn"] == "full":
        return {"path": "spin", "path_side": side, "turn": "full"}
    return {"path": "straight"} if has(text, lex.NO_TURN) and side is None and found["turn"] in (None, "none") else {}


def travel_of(words: str, found: Found) -> Found:
    """``travel`` and ``steps``; nothing where a text names several directions."""
    if has(words, lex.STEPS_IN_PLACE):
        return {"travel": "none", "steps": "in place"}
    kinds = [name for name, pattern in lex.TRAVELS if has(words, pattern)]
    goes = has(words, lex.GOES)
    if len(kinds) > 1 or (goes and "none" in kinds):
        return {"steps": "along"} if goes else {}
    if not kinds or kinds == ["forward"]:
        return _onward(words, found, goes, ahead=bool(kinds))
    return {"side": _aside, "backward": _back, "none": _nowhere}[kinds[0]](words, found, goes)


def _onward(words: str, found: Found, goes: bool, ahead: bool) -> Found:
    """Forward, to a side that is named without a turn, or nowhere."""
    aside = None if has(words, lex.BOTH_SIDES) else only(sides(words, [lex.SIDEWAYS_TO, lex.WARD]))
    if not ahead and aside and found["turn"] is None and found.get("path") is None:
        return {"steps": "along", "turn_side": aside} if goes else {"travel": aside}
    if goes and found.get("path") != "spin":
        return {"travel": "forward", "steps": "along"}
    if ahead and has(words, lex.MOVES_ON):
        return {"travel": "forward"}
    quiet = found["action"] in lex.IN_PLACE_ACTIONS and not has(words, lex.STEPS_OR_TURNS)
    return {"travel": "none"} if quiet and not has(words, lex.SEVERAL_CLAUSES) else {}


def _back(words: str, found: Found, _goes: bool) -> Found:
    returns = found["turn"] is not None or len(matches(words, lex.GOES)) > 1
    return {"steps": "along"} if returns and not has(words, lex.BACKWARD) else {"travel": "backward", "steps": "along"}


def _nowhere(_words: str, _found: Found, _goes: bool) -> Found:
    return {"travel": "none"}


def _aside(words: str, _found: Found, goes: bool) -> Found:
    if goes and has(words, lex.SEVERAL_PARTS):
        return {"steps": "along"}
    named = set() if has(words, lex.BOTH_SIDES) else sides(words, [lex.ANY_SIDE])
    return {"travel": only(named) or "sideways", "steps": "along", "turn_side": None}


def speed_of(words: str, found: Found) -> Found:
    """``speed`` and ``pace``; the speed only of a gait that stands alone."""
    speed, pace = first(words, lex.SPEEDS), first(words, lex.PACES)
    mixed = not set(found["actions"]) <= lex.ALONE_WITH or has(words, lex.SEVERAL_CLAUSES)
    if speed == "still":
        mixed = bool(set(found["actions"]) - _QUIET) or has(words, lex.GOES) or has(words, lex.SEVERAL_CLAUSES)
    elif found.get("travel") == "none" or found["turn"] in ("turn", "around"):
        mixed = True
    if mixed or (speed, pace) in (("walk", "fast"), ("run", "slow"), ("jog", "slow"), ("slow", "fast")):
        speed = None
    return {"speed": speed, "pace": pace}
