"""Hands and feet in a text: which side, how high, where they meet."""

from __future__ import annotations

from typing import Any

from motionrt.text import lexicon as lex
from motionrt.text.patterns import first, has, only, sides

Found = dict[str, Any]
_OTHER = {"left": "right", "right": "left"}


def arms_of(words: str, _found: Found) -> Found:
    """``arm`` and ``arms_up``."""
    patterns = lex.ARM_SIDE if not has(words, lex.LEG_ACTS) or has(words, lex.ARM_ACTS) else lex.ARM_SIDE[:1]
    named = sides(words, patterns)
    arm = only(named) or ("both" if named or has(words, lex.BOTH_ARMS) else None)
    up = first(words, lex.ARMS_UP)
    if up == "both" and only(named) and not has(words, lex.PAIR):
        up = "one"
    if up == "one":
        if not named and has(words, lex.PAIR_WAVES):
            return {"arm": "both", "arms_up": "both"}
        up = arm if arm in _OTHER else "both" if len(named) == 2 else "one"
        arm = arm if named else None
    return {"arm": arm, "arms_up": up}


def hands_of(words: str, _found: Found) -> Found:
    """``hands_low``, ``hands_together`` and ``lean``."""
    said = {"hands_low": lex.HANDS_LOW, "hands_together": lex.TOGETHER + "|" + lex.CLAPS, "lean": lex.LEANS}
    return {name: True for name, pattern in said.items() if has(words, pattern)}


def feet_of(words: str, _found: Found) -> Found:
    """``leg`` and ``foot_lift``."""
    support = only(sides(words, [lex.SUPPORT]))
    named = sides(words, lex.LEG_SIDE)
    lifts = has(words, lex.FOOT_LIFT)
    leg = only(named) or ("both" if named else None)
    if support and not has(words, r"kick|(?:lift|rais)\w* (?:the |his |her )?" + _OTHER[support]):
        return {"leg": None, "foot_lift": None if "kneel" in words else _OTHER[support]}
    if not lifts:
        return {"leg": leg}
    if leg in _OTHER:
        return {"leg": leg, "foot_lift": leg}
    return {"leg": leg, "foot_lift": "both" if leg == "both" or has(words, lex.HIGH_BOTH) else "one"}
