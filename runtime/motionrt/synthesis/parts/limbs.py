"""Limbs that a text names: which, on which side, and what they are to the action."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from motionrt.synthesis.parts.grammar import (
    ADJECTIVES,
    ARM,
    AT,
    BODIES,
    BY,
    DETERMINERS,
    HIPS,
    JOINTS,
    LEG,
    LIMBS,
    LOW,
    PAIRED,
    PAIRING,
    SIDES,
)
from motionrt.synthesis.parts.words import Word

BOTH = SIDES
RIGHT = frozenset({"right"})


@dataclass(frozen=True)
class Limb:
    """A limb as a text names it: words ``start`` to ``end``.

    Attributes:
        noun: its base form ("hand").
        region: arm, leg, torso or hips.
        sides: left, right or both.
        told: whether the side was said.
        role: ``object`` (what moves, or is acted on), ``with`` (by what means) or ``target`` (where to).
        plural: whether the noun is a plural.
        alone: a side without a noun ("with the left").
    """

    noun: str
    region: str
    sides: frozenset[str]
    told: bool
    role: str
    start: int
    end: int
    plural: bool = False
    alone: bool = False

    @property
    def parts(self) -> frozenset[str]:
        """The parts that it stands for; hips turn the pelvis and bend the waist."""
        if self.region in (ARM, LEG):
            return frozenset(f"{side} {self.region}" for side in self.sides)
        return frozenset({"torso", "global"} if self.region == HIPS else {"torso"})

    @property
    def low(self) -> bool:
        """Whether one bends down to reach it."""
        return self.noun in LOW

    @property
    def paired(self) -> bool:
        """Whether it is a plural of which each hand takes one ("touch the knees")."""
        return self.plural and self.noun in PAIRED


def limb_at(words: Sequence[Word], place: int, before: Limb | None) -> Limb | None:
    """The limb whose noun stands at ``place``, or None; ``before`` is the limb named last."""
    end, noun, region = _noun_at(words, place)
    if not region:
        return None
    start, said = _phrase_start(words, place)
    role, coordinated = _role(words, start, before, region)
    sides = frozenset(said & SIDES)
    plural = words[end - 1].text != noun or (not said and _counts_several(words, end))
    if said & PAIRING or (not sides and "other" in said and "one" not in said and before is None):
        sides = BOTH
    elif "other" in said:
        sides = _other(before, region)
    elif not sides and coordinated and before is not None and before.told and not said & DETERMINERS:
        sides = before.sides
    return Limb(noun, region, sides or (BOTH if plural else RIGHT), bool(sides), role, start, end, plural)


def _noun_at(words: Sequence[Word], place: int) -> tuple[int, str, str]:
    """End of the noun at ``place``, the noun and its region ("" where it is no limb)."""
    text, after = words[place].text, words[place + 1].text if place + 1 < len(words) else ""
    if text in BODIES and after in ("body", "half"):
        return place + 2, after, BODIES[text]
    noun = next((base for base in words[place].bases if base in LIMBS), "")
    if not noun or words[place].text.endswith(("ing", "ed")) or not _is_noun(words, place, noun, after):
        return place + 1, "", ""
    return place + 1, noun, LIMBS[noun]


def _is_noun(words: Sequence[Word], place: int, noun: str, after: str) -> bool:
    """Whether a word that may be something else ("step back", "face the door") is a limb here."""
    before = words[place - 1].text if place else ""
    after_limb = any(base in LIMBS for base in words[place + 1].bases) if place + 1 < len(words) else False
    if noun == "back":
        marked = before in DETERMINERS or before in ("upper", "lower", "of", "straight", "bent", "arched", "flat")
        return marked and not after_limb
    if noun in ("face", "bottom", "temple", "bum"):
        return before in DETERMINERS or before in AT or before in BY
    if noun in ("head", "hand", "shoulder", "elbow", "foot", "heel"):
        verb = after in ("to", "toward", "towards", "for") if noun == "head" else after in DETERMINERS
        return before in DETERMINERS | SIDES | AT | BY or not verb or after == "both"
    return True


def _phrase_start(words: Sequence[Word], noun: int) -> tuple[int, frozenset[str]]:
    """Where the noun phrase of the limb at ``noun`` begins, and the determiners and sides in it."""
    said: set[str] = set()
    start = noun
    while start:
        text = words[start - 1].text
        if text in DETERMINERS | SIDES | PAIRING:
            said.add(text)
        elif text not in ADJECTIVES and not (start > 1 and _joins(words, start - 1, noun)):
            break
        start -= 1
    return start, frozenset(said)


def _counts_several(words: Sequence[Word], place: int) -> bool:
    """Whether a plural noun of action follows a limb: "leg raises"."""
    return place < len(words) and len(words[place].text) > 3 and words[place].text.endswith("s")


def _holds(words: Sequence[Word], start: int) -> bool:
    """Whether the phrase at ``start`` is one or both hands: "with a spoon in the left hand"."""
    return any("hand" in word.bases for word in words[start : start + 3])


def _joins(words: Sequence[Word], place: int, noun: int) -> bool:
    """Whether a word goes on with the phrase: "left and right hand", "both of the hands"."""
    text, before, after = (words[i].text for i in (place, place - 1, place + 1))
    if text == "of":
        return before in PAIRING
    return text in ("and", "or") and place + 1 < noun and before in SIDES and after in SIDES | {"the"}


def _role(words: Sequence[Word], start: int, before: Limb | None, region: str) -> tuple[str, bool]:
    """Role of a limb whose phrase begins at ``start``, and whether it is coordinated with the one before."""
    previous = words[start - 1].text if start else ""
    if previous in BY and (previous != "by" or region in (ARM, LEG)):
        return "with", False
    if (previous == "of" and words[start - 2].text not in _PLACES) or (
        previous == "in" and words[start].text != "front" and _holds(words, start)
    ):
        return "with", False
    if previous in AT or previous == "by":
        return "target", False
    if before is not None and before.end == start - 1 and previous in JOINTS:
        return before.role, True
    return "object", False


def _other(before: Limb | None, region: str) -> frozenset[str]:
    """The other side than that of the limb named last."""
    if before is None or before.region != region or len(before.sides) != 1:
        return BOTH
    return SIDES - before.sides


def lone_side(words: Sequence[Word], place: int, before: Limb | None) -> Limb | None:
    """A side that stands for a limb: "with the left", "left-handed", "then the right"; None where it is a direction."""
    text = words[place].text
    after = words[place + 1].text if place + 1 < len(words) else ""
    if text not in SIDES and text not in ("both", "one"):
        return None
    if after in _SIDED:
        return Limb("", _SIDED[after], _sides(text), True, "with", place, place + 2, alone=True)
    closed = after in ("", "one", "then", "while", "up", "down", "out") or after in JOINTS or after in ".;:!?"
    start = place - 1 if place and words[place - 1].text in DETERMINERS else place
    previous = words[start - 1].text if start else ""
    if closed and previous in BY:
        return Limb("", before.region if before else "", _sides(text), True, "with", start, place + 1, alone=True)
    if closed and before is not None and before.alone and before.end in (start - 1, place - 1):
        return replace(before, sides=_sides(text), start=start, end=place + 1)
    if closed and start < place and text in SIDES and previous not in AT and before is not None and before.told:
        return Limb("", before.region, _sides(text), True, "object", start, place + 1, alone=True)
    return None


def _sides(text: str) -> frozenset[str]:
    return BOTH if text == "both" else RIGHT if text == "one" else frozenset({text})


_PLACES = frozenset({"front", "top", "side", "sides", "back", "level", "height", "both", "each", "one", "out", "line"})
_SIDED = dict.fromkeys(("handed", "hander", "handedly", "armed"), ARM) | dict.fromkeys(("footed", "legged"), LEG)
