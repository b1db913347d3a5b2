"""The lexicon's patterns, compiled once each, and small ways of asking them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from functools import cache

from motionrt.text import lexicon

_GROUP = re.compile(r"\{([a-z]\w*)\}")
_LONGEST = 1000  # characters of a text that are read


@cache
def compiled(pattern: str) -> re.Pattern[str]:
    """A pattern of the lexicon; ``{name}`` stands for its group of words."""
    groups = {**lexicon.GROUPS, "numbers": "|".join(lexicon.NUMBERS)}
    while _GROUP.search(pattern):
        pattern = _GROUP.sub(lambda match: groups[match.group(1)], pattern)
    return re.compile(pattern)


def plain(text: str) -> str:
    """Lower case, without accents, hyphens and doubled spaces."""
    letters = unicodedata.normalize("NFKD", text[:_LONGEST]).lower().replace("\u2019", "'")
    letters = "".join(letter for letter in letters if not unicodedata.combining(letter))
    return " ".join(re.sub(r"[-_/\u2010-\u2015]+", " ", letters).split())


def has(text: str, pattern: str) -> bool:
    """Whether a text holds a pattern."""
    return compiled(pattern).search(text) is not None


def without(text: str, patterns: Iterable[str]) -> str:
    """The text with a mark in place of what matches."""
    for pattern in patterns:
        text = compiled(pattern).sub("_", text)
    return text


def first(text: str, table: Iterable[tuple[str, str]]) -> str | None:
    """The name of the first pattern of a table that the text holds."""
    return next((name for name, pattern in table if has(text, pattern)), None)


def sides(text: str, patterns: Iterable[str]) -> set[str]:
    """The sides that are named in places where the patterns look."""
    return {match.group("side") for pattern in patterns for match in compiled(pattern).finditer(text)}


def only(found: set[str]) -> str | None:
    """The one element of a set, or None."""
    return next(iter(found)) if len(found) == 1 else None
