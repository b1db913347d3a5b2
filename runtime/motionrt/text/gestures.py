"""Which gestures a text means whose course is plain; see :mod:`motionrt.text.lexicon.gestures`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from motionrt.text import lexicon as lex
from motionrt.text.lexicon.gestures import Gesture, HeadGesture
from motionrt.text.patterns import affirmed, has, only, sides
from motionrt.text.query import TextAttributes
from motionrt.text.wording import worded

_SIDES = ("left", "right")
_RAISES = frozenset({None, "gesture", "stand", "stretch"})  # actions beside which hands are simply raised
_STOOD = frozenset({None, "gesture", "manipulate", "clap", "wave", "stand", "throw", "punch", "basketball"})
_HANDS = frozenset(
    {"arm", "arms_up", "arms_move", "hands_together", "claps", "repeats", "pace", "torso_move", "foot_lift", "leg"}
)
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
        stands: whether the trunk is upright: a gesture of somebody of whom nothing else is said.
        lies: whether the trunk lies on the floor while the pelvis does.
        kneels: whose knees are on the floor: ``"left"``, ``"right"``, ``"both"`` or None.
    """

    hands: tuple[tuple[str, Gesture], ...] = ()
    bows: bool = False
    marches: bool = False
    lifted: str | None = None
    head: HeadGesture | None = None
    kneels: str | None = None
    lies: bool = False
    stands: bool = False


def gestures_of_text(said: TextAttributes) -> Gestures:
    """The gestures of a text."""
    foot = said.foot_lift if said.foot_lift in _SIDES else said.leg
    found = _found(said.text, said.arm, said.leg, foot, said.arms_up if said.action in _RAISES else None)
    low = said.posture_lowest
    picks = said.action == "pick up" and said.hands_low is True and low is None and said.travel in (None, "none")
    if picks:
        hands = tuple((side, lex.REACHES_DOWN) for side in _hands("one", said.arm))
        found = replace(found, hands=hands, bows=True)
    stands = bool(found.hands) and said.posture_start == "standing" and low is None and not (said.lean or found.bows)
    kneels = found.kneels if low == "kneeling" else None
    return replace(found, kneels=kneels, lies=low == "lying", stands=stands)


def standing(said: TextAttributes) -> TextAttributes:
    """A text of nothing but a gesture or a lifted foot, done where somebody stands."""
    quiet = said.action in _STOOD and not set(said.said) - _HANDS
    does = gestures_of_text(said)
    if not quiet or not (does.hands or does.lifted):
        return said
    upright = replace(said, posture_start="standing", posture_end="standing", level="level", jumps=0)
    return replace(upright, travel="none", turn="none")


@lru_cache(maxsize=1024)
def _found(text: str, arm: str | None, leg: str | None, foot: str | None, raised: str | None) -> Gestures:
    words = affirmed(worded(text))
    if has(words, lex.NOT_GESTURES):
        return Gestures()
    pointed = only(sides(words, [lex.POINTS_TO])) if arm is None else None
    arm = arm or pointed
    hands: dict[str, Gesture] = {}
    for gesture in lex.GESTURES:
        if has(words, gesture.pattern):
            for side in _hands(gesture.hands, arm):
                hands.setdefault(side, gesture)
    if not hands and raised in (*_SIDES, "both", "one"):
        hands = dict.fromkeys(_hands("one" if raised == "one" else str(raised), arm), _RAISED)
    one = leg if leg in _SIDES else "right"
    kneels = one if has(words, lex.ONE_KNEE) else "both"
    lifted = (foot if foot in _SIDES else "left") if has(words, lex.BALANCES) else None
    head = next((head for head in lex.HEADS if has(words, head.pattern)), None)
    return Gestures(tuple(sorted(hands.items())), has(words, lex.BOWS), has(words, lex.MARCHES), lifted, head, kneels)


def _hands(which: str, arm: str | None) -> tuple[str, ...]:
    """The hands that do it."""
    if which == "both" or (which == "one" and arm == "both"):
        return _SIDES
    if which == "one":
        return (arm,) if arm in _SIDES else ("right",)
    return (which,)
