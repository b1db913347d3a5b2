"""``agreement``: how well a motion does what a text says, by measuring."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.motion.attributes import ATTRIBUTES, Attributes
from motionrt.text.query import TextAttributes
from motionrt.text.terms import Array, Columns, terms_of

NEUTRAL = 0.5  # of a text that says nothing that can be measured
_SIDE = 0.7  # share that a side which is not kept takes from the whole


@dataclass(frozen=True)
class Agreement:
    """How well a motion does what a text says.

    Attributes:
        score: 0 (not at all) to 1; 0.5 where the text says nothing that can be measured.
        reasons: what the text says, what was measured, and how well that fits, worst first.
    """

    score: float
    reasons: tuple[str, ...]

    def __float__(self) -> float:
        return self.score


def agreement(said: TextAttributes, attributes: Attributes) -> Agreement:
    """How well one motion does what a text says, and why."""
    columns = {name: np.array([getattr(attributes, name)]) for name in ATTRIBUTES}
    terms = sorted(terms_of(said, columns), key=lambda term: float(term.score[0]))
    reasons = [f"{t.said}: {t.shown} {float(columns[t.shown][0]):.2f} ({float(t.score[0]):.2f})" for t in terms]
    return Agreement(float(agreements(said, columns)[0]), tuple(reasons))


def agreements(said: TextAttributes, columns: Columns) -> Array:
    """``(N,)`` scores of many motions at once.

    Args:
        said: what the text says.
        columns: for each name of :data:`motionrt.motion.attributes.ATTRIBUTES` the values ``(N,)``.
    """
    count = len(columns["turn"])
    terms = terms_of(said, columns)
    if not terms:
        return np.full(count, NEUTRAL)
    total = np.sum([term.weight * term.score for term in terms], axis=0) / sum(term.weight for term in terms)
    sides = [term.score for term in terms if term.sided]
    return total * (1 - _SIDE + _SIDE * np.min(sides, axis=0)) if sides else np.asarray(total)
