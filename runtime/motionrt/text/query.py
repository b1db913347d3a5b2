"""``TextAttributes``: what a text says about a motion, as far as it can be measured."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from motionrt.text.lexicon import ACTIONS as _ACTIONS

ACTIONS = tuple(_ACTIONS)
"""Classes of plain actions, in the order of the slot ``action``."""

Side = str  # "left", "right" or "both"
_SIDES = {"left": "right", "right": "left"}
_SIDED = ("turn_side", "path_side", "arms_up", "arm", "leg", "foot_lift", "travel")


@dataclass(frozen=True)
class TextAttributes:
    """What a text says; None where it says nothing.

    Attributes:
        text: the text.
        action: class of the action, one of :data:`ACTIONS`.
        actions: every class that is named, in the order of the words.
        turn: ``"none"``, ``"turn"`` (a quarter, more or less), ``"around"`` (half) or ``"full"``.
        turn_side: ``"left"`` or ``"right"``.
        path: ``"straight"``, ``"curve"``, ``"circle"`` or ``"spin"`` (on the spot); path_side: as of a turn.
        course: a way that bends to one side and the other: ``"zigzag"`` or ``"eight"``.
        travel: ``"forward"``, ``"backward"``, ``"left"``, ``"right"``, ``"sideways"`` or ``"none"``.
        speed: ``"still"``, ``"slow"``, ``"walk"``, ``"jog"`` or ``"run"``: how fast the body gets on.
        pace: ``"slow"`` or ``"fast"``: an adverb, whatever it belongs to.
        arms_up: which hands come above the shoulder: ``"left"``, ``"right"``, ``"both"``, ``"one"`` or ``"none"``.
        arm, leg: which arm or leg does it: ``"left"``, ``"right"`` or ``"both"``.
        foot_lift: which foot is lifted: ``"left"``, ``"right"``, ``"one"``, ``"both"`` or ``"none"``.
        posture_start, posture_end, posture_lowest: names of :data:`motionrt.motion.attributes.POSTURES`.
        level: ``"down"``, ``"up"``, ``"down and up"`` or ``"level"``: the pelvis from start to end.
        jumps: how often both feet leave the floor, -1 for at least once.
        steps: ``"none"``, ``"in place"`` or ``"along"``.
        arms_move, legs_move, torso_move: 1 (still) to 4 (very much).
        hands_low, hands_together, lean: whether hands reach the floor, meet, and the trunk bends forward.
        still: whether it stands or stays without moving.
        repeats: how often an action is done, -1 for several times.
        claps: how often hands meet, -1 for several times.
        words: the words and phrases that were understood.
    """

    text: str
    action: str | None = None
    actions: tuple[str, ...] = ()
    turn: str | None = None
    turn_side: Side | None = None
    path: str | None = None
    path_side: Side | None = None
    course: str | None = None
    travel: str | None = None
    speed: str | None = None
    pace: str | None = None
    arms_up: Side | None = None
    arm: Side | None = None
    leg: Side | None = None
    foot_lift: Side | None = None
    posture_start: str | None = None
    posture_end: str | None = None
    posture_lowest: str | None = None
    level: str | None = None
    jumps: int | None = None
    steps: str | None = None
    arms_move: int | None = None
    legs_move: int | None = None
    torso_move: int | None = None
    hands_low: bool | None = None
    hands_together: bool | None = None
    lean: bool | None = None
    still: bool | None = None
    repeats: int | None = None
    claps: int | None = None
    words: tuple[str, ...] = ()

    @property
    def empty(self) -> bool:
        """Whether nothing was understood that could be measured or is an action."""
        return not self.said and self.action is None

    @property
    def said(self) -> dict[str, object]:
        """The attributes that the text names, without the action."""
        skipped = {"text", "action", "actions", "words"}
        each = {field.name: getattr(self, field.name) for field in fields(self) if field.name not in skipped}
        return {name: value for name, value in each.items() if value is not None}

    def mirrored(self) -> TextAttributes:
        """What the text says with left and right exchanged; ``text`` itself stays."""
        return replace(self, **{name: _SIDES.get(v, v) if (v := getattr(self, name)) else v for name in _SIDED})
