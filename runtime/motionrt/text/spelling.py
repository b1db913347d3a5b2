"""``mended``: words of movement with one slip of the pen in them, spelt right."""

from __future__ import annotations

import re
from functools import cache

from motionrt.text import lexicon as lex

_WORD = re.compile(r"[a-z]{3,}")
_LONG, _MIDDLE = 6, 5  # letters of a word from which another letter is a slip, and one too few or too many


def mended(text: str) -> str:
    """A plain text whose words of :data:`motionrt.text.lexicon.SPELT` are spelt right."""
    return _WORD.sub(lambda match: _right(match.group()), text)


@cache
def _known() -> dict[str, tuple[str, ...]]:
    """The words by their first letter."""
    words = lex.SPELT.split()
    return {letter: tuple(word for word in words if word[0] == letter) for letter in {word[0] for word in words}}


@cache
def _kept() -> frozenset[str]:
    return frozenset(lex.SPELT.split()) | frozenset(lex.RIGHT.split())


def _right(word: str) -> str:
    if word in _kept():
        return word
    if word == "teh":
        return "the"
    first = _known().get(word[0], ())
    swapped = _known().get(word[1], ()) if word[1] != word[0] else ()
    return next((known for known in (*first, *swapped) if _slipped(word, known)), word)


def _slipped(word: str, known: str) -> bool:
    """Whether one slip makes a word of another one: a letter too few or too many, another one, two exchanged."""
    longer = len(word) - len(known)
    if longer == 0:
        off = [place for place, (a, b) in enumerate(zip(word, known, strict=True)) if a != b]
        if len(off) == 1:
            return len(known) >= _LONG and off[0] > 0
        return (
            len(off) == 2 and off[1] == off[0] + 1 and word[off[0]] == known[off[1]] and word[off[1]] == known[off[0]]
        )
    if word[0] != known[0]:
        return False
    if longer == -1:
        return len(known) >= _MIDDLE and any(known[:k] + known[k + 1 :] == word for k in range(1, len(known)))
    if longer == 1:
        extra = [k for k in range(1, len(word)) if word[:k] + word[k + 1 :] == known]
        return bool(extra) and (len(known) >= _MIDDLE or any(word[k] == word[k - 1] for k in extra))
    return False
