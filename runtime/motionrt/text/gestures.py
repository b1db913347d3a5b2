"""Which gestures a text means whose course is plain; see :mod:`motionrt.text.lexicon.gestures`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from motionrt.text import lexicon as lex
from motionrt.text.lexicon.gestures import Gesture, HeadGesture
from motionrt.text.patterns import affirmed, has, plain
from motionrt.text.query import TextAttributes

_SIDES = ("left", "right")
_RAISES = frozenset({None, "gesture", "stand", "stretch"})  # actions beside which hands are simply raised
_RAISED = Gesture("", "both", ((0.0, 0.04, 0.46, 0.06),))


@dataclass(frozen=True)
class Gestures:
    """What a text says of hands, trunk and feet.

    Attributes:
        hands: for each hand that does something, its side and what it does.
        bows: whether the trunk goes down to the front and comes up again.
        marches: whether the knees come up in turn.
        lifted: the side of the foot that stays lifted, or None.
        head: what the head does, or None.
        kneels: whose knees are on the floor: ``"left"``, ``"right"``, ``"both"`` or None.
    """

    hands: tuple[tuple[str, Gesture], ...] = ()
    bows: bool = False
    marches: bool = False
    lifted: str | None = None
    head: HeadGesture | None = None
    kneels: str | None = None


def gestures_of_text(said: TextAttributes) -> Gestures:
    """The gestures of a text."""
    found = _found(said.text, said.arm, said.leg, said.arms_up if said.action in _RAISES else None)
    return found if said.posture_lowest == "kneeling" or not found.kneels else replace(found, kneels=None)


@lru_cache(maxsize=1024)
def _found(text: str, arm: str | None, leg: str | None, raised: str | None) -> Gestures:
    words = affirmed(plain(text))
    if has(words, lex.NOT_GESTURES):
        return Gestures()
    hands: dict[str, Gesture] = {}
    for gesture in lex.GESTURES:
        if has(words, gesture.pattern):
            for side in _hands(gesture.hands, arm):
                hands.setdefault(side, gesture)
    if not hands and raised in (*_SIDES, "both", "one"):
        hands = dict.fromkeys(_hands("one" if raised == "one" else str(raised), arm), _RAISED)
    one = leg if leg in _SIDES else "right"
    kneels = one if has(words, lex.ONE_KNEE) else "both"
    lifted = (leg if leg in _SIDES else "left") if has(words, lex.BALANCES) else None
    head = next((head for head in lex.HEADS if has(words, head.pattern)), None)
    return Gestures(tuple(sorted(hands.items())), has(words, lex.BOWS), has(words, lex.MARCHES), lifted, head, kneels)


def _hands(which: str, arm: str | None) -> tuple[str, ...]:
    """The hands that do it."""
    if which == "both" or (which == "one" and arm == "both"):
        return _SIDES
    if which == "one":
        return (arm,) if arm in _SIDES else ("right",)
    return (which,)
