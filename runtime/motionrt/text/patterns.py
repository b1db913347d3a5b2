"""The lexicon's patterns, compiled once each, and small ways of asking them."""

from __future__ import annotations

import json
import re
import unicodedata
import zlib
from collections.abc import Iterable
from functools import cache, lru_cache
from pathlib import Path

from motionrt.text import lexicon

_GROUP = re.compile(r"\{([a-z]\w*)\}")
_LONGEST = 1000  # characters of a text that are read
TRIGGERS_FILE = Path(__file__).parents[1] / "_assets" / "text_triggers.json"


def groups_of_words() -> dict[str, str]:
    """What ``{name}`` stands for in patterns."""
    return {**lexicon.GROUPS, "numbers": "|".join(lexicon.NUMBERS)}


@cache
def compiled(pattern: str) -> re.Pattern[str]:
    """A pattern of the lexicon; ``{name}`` stands for its group of words."""
    groups = groups_of_words()
    while _GROUP.search(pattern):
        pattern = _GROUP.sub(lambda match: groups[match.group(1)], pattern)
    return re.compile(pattern)


def key(pattern: str) -> str:
    """What a pattern is called in the file of triggers."""
    return f"{zlib.crc32(pattern.encode()):08x}"


@cache
def _triggers(pattern: str) -> tuple[str, ...] | None:
    """Strings of which a text must hold one where the pattern is to match; None where that is not known."""
    found = _all_triggers().get(key(pattern))
    return None if found is None else tuple(found)


@lru_cache(maxsize=1)
def _all_triggers() -> dict[str, list[str]]:
    table: dict[str, list[str]] = json.loads(TRIGGERS_FILE.read_text(encoding="ascii"))
    return table


def may_match(text: str, pattern: str) -> bool:
    """Whether a pattern has to be tried: false only where it cannot match."""
    needed = _triggers(pattern)
    return needed is None or any(letters in text for letters in needed)


def matches(text: str, pattern: str) -> list[re.Match[str]]:
    """Every place where a text holds a pattern."""
    return list(compiled(pattern).finditer(text)) if may_match(text, pattern) else []


def plain(text: str) -> str:
    """Lower case, without accents, hyphens and doubled spaces."""
    letters = unicodedata.normalize("NFKD", text[:_LONGEST]).lower().replace("\u2019", "'")
    letters = "".join(letter for letter in letters if not unicodedata.combining(letter))
    return " ".join(re.sub(r"[-_/\u2010-\u2015]+", " ", letters).split())


def affirmed(whole: str) -> str:
    """A plain text without what it denies, and without sides that are none ("right away")."""
    return without(without(whole, [lexicon.NEGATION]), lexicon.NO_SIDES)


def has(text: str, pattern: str) -> bool:
    """Whether a text holds a pattern."""
    return may_match(text, pattern) and compiled(pattern).search(text) is not None


def without(text: str, patterns: Iterable[str]) -> str:
    """The text with a mark in place of what matches."""
    for pattern in patterns:
        text = compiled(pattern).sub("_", text) if may_match(text, pattern) else text
    return text


def first(text: str, table: Iterable[tuple[str, str]]) -> str | None:
    """The name of the first pattern of a table that the text holds."""
    return next((name for name, pattern in table if has(text, pattern)), None)


def sides(text: str, patterns: Iterable[str]) -> set[str]:
    """The sides that are named in places where the patterns look."""
    return {match.group("side") for pattern in patterns for match in matches(text, pattern)}


def only(found: set[str]) -> str | None:
    """The one element of a set, or None."""
    return next(iter(found)) if len(found) == 1 else None
