"""Whether a query has any word that motionrt or the library knows."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from motionrt.retrieval.words import WordIndex, stems
from motionrt.text import parse_query

_ASSETS = Path(__file__).parents[1] / "_assets"
_LISTS = ("action_words.tsv", "captions.txt")


def unknown_words(text: str, library: WordIndex | None = None) -> tuple[str, ...]:
    """The telling words of a text, when neither the parser, nor motionrt's lists of actions, nor the library knows any.

    Empty as soon as one is known: the embedding then makes sense of the rest.
    """
    if not parse_query(text).empty or (library is not None and library.known(text)):
        return ()
    asked = stems(text)
    if any(word in _vocabulary() for word in asked):
        return ()
    return tuple(dict.fromkeys(word for word in text.split() if stems(word))) or (text.strip(),)


@lru_cache(maxsize=1)
def _vocabulary() -> frozenset[str]:
    """Stems of the packaged lists of actions and captions."""
    lines = [line for name in _LISTS for line in (_ASSETS / name).read_text(encoding="utf-8").splitlines()]
    return frozenset(word for line in lines if not line.startswith("#") for word in stems(line))
