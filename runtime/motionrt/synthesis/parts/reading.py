"""From words to clauses: the actions and limbs of each, and whether it denies them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from motionrt.synthesis.parts.grammar import (
    ADJECTIVES,
    BREAKS,
    BY,
    DETERMINERS,
    JOINTS,
    LIMBS,
    NEGATIONS,
    OF,
    PAIRING,
    PARTICLES,
    SIDES,
    word_set,
)
from motionrt.synthesis.parts.lexicon import Entry, Lexicon
from motionrt.synthesis.parts.limbs import Limb, limb_at, lone_side
from motionrt.synthesis.parts.words import Word


@dataclass(frozen=True)
class Act:
    """A phrase of the lexicon where it stands in the text, words ``start`` to ``end``.

    Attributes:
        entry: what the lexicon says of it.
        nominal: it follows an article, so that it may be a thing ("the box") rather than an action.
        inflected: its first word ends in -ing or -ed.
        sides: sides that stand before it ("a left jab").
        phrase_start: where its phrase begins, with articles, sides and adjectives.
    """

    entry: Entry
    start: int
    end: int
    nominal: bool
    inflected: bool
    sides: frozenset[str]
    phrase_start: int


@dataclass
class Clause:
    """Words ``start`` to ``end`` with their actions and limbs; ``joined`` to the clause before by "and" or a comma."""

    start: int
    end: int
    joined: bool = False
    negated: bool = False
    acts: list[Act] = field(default_factory=list)
    limbs: list[Limb] = field(default_factory=list)


def clauses_of(words: Sequence[Word], lexicon: Lexicon) -> list[Clause]:
    """The clauses of a text, in order; those with neither action nor limb are left out."""
    acts, limbs = marks(words, lexicon)
    clauses = [Clause(start, end, joined) for start, end, joined in _spans(words, acts)]
    for clause in clauses:
        clause.acts = _chosen([act for act in acts if clause.start <= act.start < clause.end])
        clause.limbs = [limb for limb in limbs if clause.start <= limb.end - 1 < clause.end]
        clause.negated = any(word.text in NEGATIONS for word in words[clause.start : clause.end])
    return [clause for clause in clauses if clause.acts or clause.limbs]


def marks(words: Sequence[Word], lexicon: Lexicon) -> tuple[list[Act], list[Limb]]:
    """All actions and limbs of a text, longest phrases first, from left to right."""
    acts: list[Act] = []
    limbs: list[Limb] = []
    place = 0
    while place < len(words):
        last = limbs[-1] if limbs else None
        limb = limb_at(words, place, last)
        found = lexicon.match(words, place)
        if found and limb and not _phrase_wins(words, place, found[0], found[1]):
            found = None
        if found and not (words[place].text in SIDES and found[1] == place + 1):
            acts.append(_act(words, place, *found))
            place = found[1]
            continue
        limb = limb or lone_side(words, place, last)
        if limb:
            limbs.append(limb)
        place = limb.end if limb else place + 1
    return acts, limbs


def _phrase_wins(words: Sequence[Word], place: int, entry: Entry, end: int) -> bool:
    """Whether a phrase that begins with a limb ("knee strike") is the action, not the limb as its subject."""
    if end == place + 1:
        return False
    if entry.phrase[1] in PARTICLES and place and words[place - 1].text in SIDES | DETERMINERS:
        return False
    sided = place > 0 and words[place - 1].text in SIDES | PAIRING
    return not sided or not set(entry.parts) & set("AL")


def _act(words: Sequence[Word], start: int, entry: Entry, end: int) -> Act:
    place, sides = start, set()
    while place and words[place - 1].text in SIDES | ADJECTIVES | PAIRING | {"and"}:
        place -= 1
        sides |= {words[place].text} & SIDES
        if words[place].text in PAIRING:
            sides |= SIDES
    within = {word.text for word in words[start:end]}
    sides |= (within & SIDES) if entry.phrase[-1] in LIMBS or set(entry.parts) & set("al") else set()
    before = words[place - 1].text if place else ""
    single = end == start + 1
    nominal = (before in DETERMINERS or (single and before in OF)) and not words[start].inflected
    first = place - 1 if place and words[place - 1].text in DETERMINERS else place
    return Act(entry, start, end, nominal, words[start].inflected, frozenset(sides), first)


def _chosen(acts: list[Act]) -> list[Act]:
    """Without things that only look like actions: "the box", "lift box"."""
    plain = [act for act in acts if not act.nominal or any(_carries(one, act) for one in acts)]
    if any(act.entry.kind != "light" for act in plain):
        acts = plain
    kept: list[Act] = []
    for act in acts:
        last = kept[-1] if kept else None
        is_object = (
            last and last.end == act.start and last.entry.kind in ("move", "reach", "grip") and not act.inflected
        )
        if not is_object or len(act.entry.phrase) > 1:
            kept.append(act)
    return [act for act, after in zip(kept, [*kept[1:], None], strict=False) if not _carries(act, after)]


def _carries(act: Act, after: Act | None) -> bool:
    """Whether a verb only carries the noun that follows: "take a step", "throws a hook", "hold a low stance"."""
    if after is None or after.inflected or len(act.entry.phrase) > 1 or act.entry.phrase[0] not in _CARRIERS:
        return False
    return after.phrase_start <= act.end and after.entry.kind != "light"


_CARRIERS = word_set("take give throw get hold make keep land deliver")


def _spans(words: Sequence[Word], acts: Sequence[Act]) -> list[tuple[int, int, bool]]:
    """Start, end and joint of each clause."""
    inside = {place for act in acts for place in range(act.start + 1, act.end)}
    actions = [act.start for act in acts if act.entry.kind != "light"]
    spans: list[tuple[int, int, bool]] = []
    start, joined = 0, False
    for place, word in enumerate(words):
        if place in inside or not _begins(words, place, start, actions):
            continue
        spans.append((start, place, joined))
        start, joined = place, word.text in JOINTS
    spans.append((start, len(words), joined))
    return [span for span in spans if span[1] > span[0]]


def _begins(words: Sequence[Word], place: int, start: int, actions: Sequence[int]) -> bool:
    """Whether a new clause begins with the word at ``place``."""
    text = words[place].text
    if text in BREAKS:
        return text != "then" or not _between_sides(words, place)
    if text in NEGATIONS:
        return any(start <= action < place for action in actions)
    if text not in JOINTS or _between_sides(words, place):
        return False
    if text == "," and words[start].text in BY and not any(start <= action < place for action in actions):
        return False  # "with the left foot, she draws circles"
    until = next((i for i in range(place + 1, len(words)) if words[i].text in BREAKS | JOINTS), len(words))
    before = any(start <= action < place for action in actions)
    return any(place < action < until for action in actions) and (before or _has_limb(words, start, place))


def _between_sides(words: Sequence[Word], place: int) -> bool:
    return 0 < place < len(words) - 1 and words[place - 1].text in SIDES and words[place + 1].text in SIDES


def _has_limb(words: Sequence[Word], start: int, end: int) -> bool:
    return any(base in LIMBS for word in words[start:end] for base in word.bases)
