"""`RulesLabeller`: body parts of action text from a lexicon and the grammar around it, offline."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.parts.grammar import ARM, DETERMINERS, LEG, word_set
from motionrt.synthesis.parts.implied import stoops, travels
from motionrt.synthesis.parts.lexicon import CLOSED, Lexicon, limb_spelling, load_lexicon
from motionrt.synthesis.parts.limbs import Limb
from motionrt.synthesis.parts.reading import Act, Clause, clauses_of
from motionrt.synthesis.parts.resolving import NONE, Found, coded, has_thing, resolve
from motionrt.synthesis.parts.stillness import keeps, kept_still, on_one_leg, on_the_spot
from motionrt.synthesis.parts.words import Word, base_forms, words_of

Encode = Callable[[str], npt.ArrayLike]


@dataclass(frozen=True)
class Reason:
    """Why a part is in an answer, or is not.

    Attributes:
        words: the words of the text that say it.
        rule: the rule, in words.
        parts: what they give.
        adds: False where the parts are taken out ("without moving the arms").
    """

    words: str
    rule: str
    parts: frozenset[str]
    adds: bool = True


class RulesLabeller:
    """Action text -> body parts, in well under a millisecond, without a model.

    Where the text leaves it open: an action of the hand moves both arms ("wave", "throw"), as either may do it, a kick
    the right leg, and one hand that is named is the right ("raise a hand"); arms that are not mentioned swing when
    somebody runs or marches, and stay out of walking and jumping; turns move the torso; standing counts only where
    nothing else is said, and then as the legs; on the spot, walking loses the global part; a limb that is held in a
    posture ("hands in the pockets", "arms attached to the waist") belongs to the action, one that is kept still or
    denied does not. Text without any known word: both arms where it names an object ("whittle a stick"), else the whole
    body.

    Args:
        encoder: optional ``text -> (D,)`` unit embedding, such as that of the sentence encoder: text without any known
            word then takes the parts of the nearest phrase of the lexicon. All phrases are encoded at the first such
            text, which takes seconds.
        lexicon: the words; the packaged ones by default.
    """

    def __init__(self, encoder: Encode | None = None, lexicon: Lexicon | None = None) -> None:
        self._lexicon = load_lexicon() if lexicon is None else lexicon
        self._encoder = encoder
        self._table: npt.NDArray[np.float32] | None = None

    def __call__(self, text: str) -> frozenset[str]:
        """The parts of :data:`motionrt.motion.body_parts.PARTS` that ``text`` speaks of.

        Raises:
            InvalidInputError: not a string, or nothing but white space.
        """
        return settled(self.explain(text))

    def explain(self, text: str) -> tuple[Reason, ...]:
        """Which words gave or took which parts, in the order of the text; raises as a call does."""
        if not isinstance(text, str) or not text.strip():
            raise InvalidInputError("the action text is empty; say what somebody does, as in 'wave the right hand'")
        words = self._mended(words_of(text), boldly=False)
        clauses = clauses_of(words, self._lexicon)
        if not any(clause.acts for clause in clauses):
            words = self._mended(words, boldly=True)
            clauses = clauses_of(words, self._lexicon)
        reasons = [reason for number in range(len(clauses)) for reason in self._clause(clauses, number, words)]
        if any(reason.parts for reason in reasons) or any(not reason.adds for reason in reasons):
            return tuple(_background(reasons))
        return (*reasons, self._unknown(text, words))

    def _mended(self, words: Sequence[Word], *, boldly: bool) -> list[Word]:
        before = ["", *(word.text for word in words)]
        return [self._mended_word(word, last, boldly) for word, last in zip(words, before, strict=False)]

    def _mended_word(self, word: Word, before: str, boldly: bool) -> Word:
        known = self._lexicon
        if any(base in known or base in known.nouns or base in CLOSED for base in word.bases):
            return word
        better = (limb_spelling() if before in DETERMINERS else known.spelling).mended(word.text, boldly=boldly)
        return Word(better, base_forms(better)) if better else word

    def _clause(self, clauses: Sequence[Clause], number: int, words: Sequence[Word]) -> list[Reason]:
        clause = clauses[number]
        quiet = [limb for limb in clause.limbs if kept_still(limb, clause, words)]
        denied = clause.limbs if clause.negated else quiet
        reasons = [
            Reason(_text(words, limb.start, limb.end), "kept still or denied", limb.parts, False) for limb in denied
        ]
        if clause.negated:
            return reasons
        acts = [act for act in clause.acts if act.entry.kind != "light"]
        limbs = [limb for limb in clause.limbs if limb not in quiet]
        acts = [act for act in acts if not keeps(act, quiet) and not _uses(act, limbs)]
        owners = {limb: _owner(limb, acts) for limb in limbs}
        for act in acts:
            own = [limb for limb in limbs if owners[limb] is act] or _beside(act, acts, limbs, owners)
            own = own or self._shared(act, clauses, number, words)
            reasons += self._act(act, own, clause, words)
        return reasons + [_posture(limb, words) for limb in limbs if owners[limb] is None and limb.role != "target"]

    def _act(self, act: Act, limbs: Sequence[Limb], clause: Clause, words: Sequence[Word]) -> list[Reason]:
        said = _text(words, act.start, act.end)
        if on_the_spot(act, clause, words):
            return [Reason(said, "lexicon, on the spot", coded(act.entry.parts) - {"global"})]
        found = resolve(act, limbs, clause, words, self._lexicon)
        named = " ".join([said, *(_text(words, limb.start, limb.end) for limb in limbs)])
        if act.entry.kind == "still":
            if on_one_leg(limbs, words):
                return [Reason(named, "stands on one leg", frozenset(LEGS))]
            moved = [Found(limb.parts, "the limb is held so") for limb in limbs if limb.role != "target"]
            still = Reason(said, STILL_RULE, coded(act.entry.parts))
            return [still, *(Reason(named, one.rule, one.parts) for one in moved)]
        way = travels(act, limbs, clause, words)
        found += [Found(way, "moved along on foot")] if way else []
        low = stoops(act, clause, words)
        found += [Found(low, "picked up, so stooped to")] if low else []
        return [Reason(said if one.rule.startswith("lexicon") else named, one.rule, one.parts) for one in found]

    def _shared(self, act: Act, clauses: Sequence[Clause], number: int, words: Sequence[Word]) -> list[Limb]:
        """The limb of a neighbour clause where a verb that needs one has none: "raise and lower the left arm"."""
        if act.entry.kind != "move" or set(act.entry.parts) - set("Aa") or has_thing(act, words, self._lexicon):
            return []
        if act.sides:
            return []
        after = clauses[number + 1] if number + 1 < len(clauses) and clauses[number + 1].joined else None
        if after and act is clauses[number].acts[-1] and not clauses[number].limbs and not after.negated:
            limbs = [limb for limb in after.limbs if limb.role == "object" and _owner(limb, after.acts) in after.acts]
            needs = act.entry.with_thing != act.entry.parts or act.entry.phrase[0] in _NEEDY
            if limbs and after.acts and needs and after.acts[0].entry.kind in ("move", "grip"):
                return limbs
        before = clauses[number - 1] if number else None
        if before and not before.negated and any(one.entry.kind == "move" for one in before.acts):
            return [limb for limb in before.limbs if limb.role == "object" and limb.region in (ARM, LEG) and limb.told]
        return []

    def _unknown(self, text: str, words: Sequence[Word]) -> Reason:
        if self._encoder is not None:
            phrase, parts = self._nearest(text)
            return Reason(text.strip(), f"no known word; nearest in meaning: '{phrase}'", parts)
        if any(word.text in DETERMINERS or word.text in ("with", "using") for word in words[1:]):
            return Reason(text.strip(), "no known word, but an object: both hands", frozenset(ARMS))
        return Reason(text.strip(), "no known word: the whole body", frozenset(PARTS))

    def _nearest(self, text: str) -> tuple[str, frozenset[str]]:
        encode = self._encoder
        entries = [entry for entry in self._lexicon.entries if entry.kind not in ("light", "still")]
        if encode is None:
            return "", NONE
        if self._table is None:
            self._table = np.stack([np.asarray(encode(" ".join(entry.phrase)), np.float32) for entry in entries])
        best = entries[int(np.argmax(self._table @ np.asarray(encode(text), np.float32)))]
        return " ".join(best.phrase), coded(best.parts)


STILL_RULE = "a posture, which counts where nothing else is said"
_NEEDY = word_set("raise lift lower extend swing wave shake circle drop stretch rotate move clap flap")


def settled(reasons: Sequence[Reason]) -> frozenset[str]:
    """The parts that remain when denials are taken out; legs that carry the body stay."""
    given: set[str] = set().union(*(reason.parts for reason in reasons if reason.adds))
    taken: set[str] = set().union(*(reason.parts for reason in reasons if not reason.adds))
    if "global" in given:
        taken -= {*LEGS, "global"}
    still = frozenset().union(*(reason.parts for reason in reasons if reason.rule == STILL_RULE))
    return frozenset(given - taken) or still


def _background(reasons: Sequence[Reason]) -> list[Reason]:
    """Without postures of standing where something else is done."""
    doing = [reason for reason in reasons if reason.adds and reason.rule != STILL_RULE and reason.parts]
    return [reason for reason in reasons if not doing or reason.rule != STILL_RULE]


def _owner(limb: Limb, acts: Sequence[Act]) -> Act | None:
    """The action that a limb belongs to: the one before it, or the one of which it is the subject."""
    before = [act for act in acts if act.end <= limb.start and act.entry.kind != "light"]
    after = [act for act in acts if act.start >= limb.end and act.entry.kind != "light"]
    if before and (limb.role == "target" or not after):
        return before[-1]
    if not after:
        return None
    close = after[0].start - limb.end <= 1 and after[0].entry.kind != "still"
    if before and not (close and (limb.role == "with" or before[-1].entry.kind not in ("move", "reach", "grip"))):
        return before[-1]
    return after[0] if limb.role != "target" else None


def _beside(act: Act, acts: Sequence[Act], limbs: Sequence[Limb], owners: Mapping[Limb, Act | None]) -> list[Limb]:
    """Limbs that a verb shares with a participle: "hold the arms bent", "move joined hands"."""
    if act.entry.kind != "move":
        return []
    if act.inflected:
        return [limb for limb in limbs if limb.end == act.start]
    after = next((one for one in acts if one.start >= act.end), None)
    if after is None or not after.inflected or after.phrase_start > act.end:
        return []
    return [limb for limb in limbs if owners[limb] is after]


def _uses(act: Act, limbs: Sequence[Limb]) -> bool:
    """Whether a verb only says by which limb: "use the left foot to kick"."""
    return act.entry.phrase == ("use",) and any(limb.start == act.end for limb in limbs)


def _posture(limb: Limb, words: Sequence[Word]) -> Reason:
    return Reason(
        _text(words, limb.start, limb.end),
        "a limb that is named",
        limb.parts if limb.region else coded("a", limb.sides),
    )


def _text(words: Sequence[Word], start: int, end: int) -> str:
    return " ".join(word.text for word in words[start:end])
