"""What an action moves, given the limbs and things that are named with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.parts.grammar import (
    ADJECTIVES,
    ALTERNATING,
    ARM,
    AT,
    BREAKS,
    DETERMINERS,
    JOINTS,
    LEG,
    LIMBS,
    LOW,
    NO_THINGS,
    PARTICLES,
    PASSIVE,
    POSED,
    SIDES,
    word_set,
)
from motionrt.synthesis.parts.implied import several_legs, worn_on
from motionrt.synthesis.parts.lexicon import Lexicon
from motionrt.synthesis.parts.limbs import BOTH, RIGHT, Limb
from motionrt.synthesis.parts.reading import Act, Clause
from motionrt.synthesis.parts.words import Word

NONE: frozenset[str] = frozenset()
_STOOPING = word_set(
    "pick touch place put set reach grab take lift collect get gather lay retrieve fetch lower tap feel grasp"
)
_RAISED = word_set("up out high straight bent behind forward back raised lifted extended sideways")


@dataclass(frozen=True)
class Found:
    """Parts that an action or limb gives, and by which rule."""

    parts: frozenset[str]
    rule: str


def coded(code: str, sides: frozenset[str] = RIGHT) -> frozenset[str]:
    """The parts of a code of the lexicon; ``sides`` are those of one-sided actions."""
    parts: set[str] = set(PARTS) if "W" in code else set()
    parts |= set(ARMS) if "A" in code else {f"{side} arm" for side in sides if "a" in code}
    parts |= set(LEGS) if "L" in code else {f"{side} leg" for side in sides if "l" in code}
    return frozenset(parts | {name for letter, name in (("T", "torso"), ("G", "global")) if letter in code})


def resolve(act: Act, limbs: Sequence[Limb], clause: Clause, words: Sequence[Word], lexicon: Lexicon) -> list[Found]:
    """What ``act`` moves, with ``limbs`` as those that belong to it."""
    kind = act.entry.kind
    if limbs and all(limb.noun in _FACE for limb in limbs) and act.entry.phrase[0] in _FACIAL:
        return []  # "with the eyes closed"
    thing = kind in ("move", "grip") and has_thing(act, words, lexicon)
    code = act.entry.with_thing if thing else act.entry.parts
    movers = [limb for limb in limbs if _moves(act, limb)]
    targets = [limb for limb in limbs if limb.role == "target" or (limb.role == "object" and limb not in movers)]
    means = [limb for limb in limbs if limb.role == "with" and limb not in movers]
    if kind == "reach" and any(limb.noun in _MEETING for limb in targets if limb.role == "object"):
        objects = [limb for limb in targets if limb.role == "object"]
        met = _meeting(objects, [limb for limb in targets if limb.role == "target"])
        if met:
            return [Found(_union(objects), "the limb that moves"), *met]
    if kind == "move" and movers:
        found = [Found(_union(movers), "the limb that moves")]
        found += [Found(limb.parts, "the limb it is done with") for limb in means]
        return found + _meeting(movers, targets) + _stooping(act, clause, found, words)
    found = [_on_one_foot(act, _base(act, code, clause, targets, words, lexicon), targets, words)]
    if kind == "grip":
        found += [Found(limb.parts, "the limb that is held") for limb in targets if limb.region == LEG]
        if any(limb.region == LEG for limb in targets) and _held_up(targets, words):
            found = found[1:]
    narrowing = movers + [limb for limb in means if not _posed(limb, words)]
    found = [_narrowed(found[0], narrowing, code), *found[1:]]
    worn = worn_on(act, clause, words)
    found += [Found(frozenset(f"{side} leg" for side in worn), "the leg that it is worn on")] if worn else []
    posed = [limb for limb in means if _posed(limb, words)]
    found += [Found(limb.parts, "the limb is held so") for limb in posed]
    return found + _stooping(act, clause, found, words)


def _moves(act: Act, limb: Limb) -> bool:
    """Whether a limb without a preposition is what moves, not what is acted on."""
    kind = act.entry.kind
    if limb.role == "target" or (limb.noun in PASSIVE and kind != "act"):
        return False
    if limb.role == "with":
        return limb.start < act.start and kind == "move"
    if limb.start < act.start or kind in ("move", "act", "gait", "still"):
        return True
    return kind == "grip" and limb.region == ARM and limb.noun not in ("elbow", "shoulder", "wrist")


def _base(
    act: Act, code: str, clause: Clause, targets: Sequence[Limb], words: Sequence[Word], lexicon: Lexicon
) -> Found:
    """The parts of the lexicon with the side that the words give."""
    one_sided = set(code) & set("al")
    if not one_sided:
        return Found(coded(code), "lexicon")
    worn = worn_on(act, clause, words) if "l" in code else NONE
    if act.sides or worn:
        return Found(coded(code, act.sides or worn), "lexicon, with the side said before it")
    here = words[clause.start : clause.end]
    in_turn = any(word.text in ALTERNATING for word in here) or ("l" in code and several_legs(targets, words))
    if in_turn or _both_after(act, words) or _several(act, words):
        return Found(coded(code, BOTH), "lexicon, both sides in turn")
    if "a" in code and (any(limb.paired for limb in targets) or _big(act, clause, words, lexicon)):
        return Found(coded(code, BOTH), "lexicon, both hands for what is big or paired")
    aside = [limb for limb in targets if limb.region == ARM and limb.told and len(limb.sides) == 1]
    if aside and "a" in code:
        return Found(coded(code, SIDES - aside[0].sides), "lexicon, the hand opposite to the arm that it goes to")
    return Found(
        coded(code, BOTH if "a" in code else RIGHT), f"lexicon; no side said: {'both' if 'a' in code else 'right'}"
    )


def _on_one_foot(act: Act, found: Found, targets: Sequence[Limb], words: Sequence[Word]) -> Found:
    """Hops and jumps on one foot move that leg alone."""
    feet = [limb for limb in targets if limb.region == LEG and limb.told and words[limb.start - 1].text == "on"]
    if act.entry.phrase[0] not in _HOPS or len(feet) != 1 or len(feet[0].sides) != 1:
        return found
    return Found((found.parts - set(LEGS)) | feet[0].parts, "the foot that it is done on")


def _several(act: Act, words: Sequence[Word]) -> bool:
    """Whether the phrase ends in a plural: "throw punches"."""
    last = words[act.end - 1].text
    return len(act.entry.phrase) > 1 and act.entry.phrase[0] == "throw" and last != act.entry.phrase[-1]


def _both_after(act: Act, words: Sequence[Word]) -> bool:
    """Whether "left and right" or "left then right" follows at once."""
    after = [word.text for word in words[act.end : act.end + 3]]
    return len(after) == 3 and {after[0], after[2]} == SIDES and after[1] in JOINTS | {"then"}


def _big(act: Act, clause: Clause, words: Sequence[Word], lexicon: Lexicon) -> bool:
    """Whether the direct object takes both hands."""
    for word in words[act.end : min(clause.end, act.end + 6)]:
        if word.text in AT - {"of"}:
            return False
        if any(base in lexicon.big for base in word.bases):
            return True
    return False


def _narrowed(found: Found, limbs: Sequence[Limb], code: str) -> Found:
    """Arms or legs of an action replaced by those that are named with it; whole-body actions only gain."""
    parts, rule = found.parts, found.rule
    if not set(code) - set("Aa") and limbs and all(limb.region == LEG and limb.role == "with" for limb in limbs):
        parts = NONE  # "draw a circle with the left foot"
    for region, side_parts in ((ARM, frozenset(ARMS)), (LEG, frozenset(LEGS))):
        named = [limb for limb in limbs if region_of(limb, code) == region]
        if named:
            gained = frozenset(f"{side} {region}" for limb in named for side in limb.sides)
            whole = set(code) & set("GW") and not (region == LEG and "l" in code)
            keep = parts if whole else parts - side_parts
            parts, rule = keep | gained, "the limb it is done with"
    others = _union([limb for limb in limbs if region_of(limb, code) not in (ARM, LEG)])
    return Found(parts | others, rule)


def region_of(limb: Limb, code: str) -> str:
    """The region of a limb; a side without a noun is that of the action."""
    if limb.region:
        return limb.region
    return LEG if "l" in code else ARM


def _posed(limb: Limb, words: Sequence[Word]) -> bool:
    """Whether "with a hand ..." goes on with where the hand is held: a posture, not a means."""
    after = words[limb.end].text if limb.end < len(words) else ""
    return after in POSED


def _held_up(targets: Sequence[Limb], words: Sequence[Word]) -> bool:
    return any(limb.end < len(words) and words[limb.end].text in _RAISED for limb in targets)


def _meeting(movers: Sequence[Limb], targets: Sequence[Limb]) -> list[Found]:
    """Elbow and knee meet half way: the target moves too, and the trunk bends."""
    if any(limb.noun in _MEETING for limb in movers):
        met = [limb for limb in targets if limb.noun in ("knee", "elbow", "foot", "toe")]
        if met:
            return [Found(_union(met) | {"torso"}, "limbs that meet half way")]
    return []


_HOPS = frozenset({"hop", "jump", "bounce", "skip"})
_FACE = frozenset({"eye", "mouth", "lip", "eyebrow", "brow", "jaw"})
_FACIAL = frozenset({"open", "close", "shut", "squeeze", "move"})
_MEETING = frozenset({"elbow", "knee", "chin", "forehead", "nose"})


def _stooping(act: Act, clause: Clause, found: Sequence[Found], words: Sequence[Word]) -> list[Found]:
    """The trunk bends where hands go to the feet or the floor."""
    arms = any(one.parts & set(ARMS) for one in found)
    if not arms or not (set(act.entry.phrase) & _STOOPING or any(limb.region == ARM for limb in clause.limbs)):
        return []
    held = act.entry.kind == "grip" and any(limb.region == LEG for limb in clause.limbs)
    if held or set(act.entry.parts) & set("GW") or act.entry.kind == "act":
        return []
    low = any(base in LOW for word in words[act.end : clause.end] for base in word.bases)
    movers = any(limb.low and limb.role != "target" and limb.end <= act.start for limb in clause.limbs)
    return [Found(frozenset({"torso"}), "bends to what is low")] if low and not movers and _reached(act, clause) else []


def _reached(act: Act, clause: Clause) -> bool:
    """Whether the low thing is a place to reach, not a limb that moves as the arms do ("move the arms and feet")."""
    return not any(limb.low and limb.role == "object" and act.entry.kind == "move" for limb in clause.limbs)


def has_thing(act: Act, words: Sequence[Word], lexicon: Lexicon) -> bool:
    """Whether a thing is the direct object of ``act``: "twist the cap", not "twist the torso" or "twist a little"."""
    place = act.end
    while place < len(words) and words[place].text in PARTICLES:
        place += 1
    determined = False
    while place < len(words) and words[place].text in DETERMINERS | ADJECTIVES | SIDES:
        determined |= words[place].text in DETERMINERS
        place += 1
    if place >= len(words):
        return False
    word = words[place]
    if word.text in NO_THINGS | JOINTS | AT or any(base in LIMBS for base in word.bases) or word.text in SIDES:
        return False
    if not word.text.isalpha() or word.text in BREAKS or word.text.endswith("ly"):
        return False
    if act.entry.kind == "grip":
        return True
    return determined or any(base in _HANDLED or base in lexicon.big for base in word.bases)


_HANDLED = word_set(
    "ball cup mug bottle glass plate dish stick bat racket racquet club sword hammer flag bag coin key card box object "
    "something item thing stuff cap lid jar knob handle book paper towel cloth umbrella torch bell phone it them"
)


def _union(limbs: Sequence[Limb]) -> frozenset[str]:
    return frozenset().union(*(limb.parts for limb in limbs)) if limbs else NONE
