"""The lexicon of actions: which parts a verb or phrase moves when nothing more is said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

from motionrt.errors import FormatError
from motionrt.synthesis.parts.grammar import ARTICLES, LIMBS, PAIRING, PARTICLES, SIDES, word_set
from motionrt.synthesis.parts.spelling import Spelling
from motionrt.synthesis.parts.words import Word

LEXICON_FILE = Path(__file__).parents[2] / "_assets" / "action_words.tsv"
KINDS = ("gait", "act", "move", "reach", "grip", "still", "light", "big", "noun")
CLOSED = frozenset({*SIDES, *LIMBS, *PAIRING, "forward", "backward", "backwards", "while", "without"})
COUNTS = word_set("two three four five six seven eight nine ten few several some small big large long little tiny")
"""How many and how large, which a phrase does not name: "take two small steps"."""
_PASSED = ARTICLES | SIDES | {"both"}  # "tap the left foot" is "tap foot"
_CODES = frozenset("AaLlTGW-/")


@dataclass(frozen=True)
class Entry:
    """One line of the lexicon for one phrase.

    Attributes:
        phrase: base forms, without articles.
        parts: code of what moves: ``A`` both arms, ``a`` one, ``L`` both legs, ``l`` one, ``T`` torso, ``G`` global,
            ``W`` all six.
        with_thing: the same where a thing is the direct object ("twist the cap").
        kind: how limbs and objects that are named with it are understood; the head of the file says it.
    """

    phrase: tuple[str, ...]
    parts: str
    with_thing: str
    kind: str


class Lexicon:
    """Phrases by their first word, the longest first."""

    def __init__(self, entries: Sequence[Entry]) -> None:
        self.entries = [entry for entry in entries if entry.kind not in ("big", "noun")]
        self.big = {entry.phrase[0] for entry in entries if entry.kind == "big"}
        self.nouns = self.big | {entry.phrase[0] for entry in entries if entry.kind == "noun"}
        self._by_first: dict[str, list[Entry]] = {}
        for entry in sorted(self.entries, key=lambda entry: -len(entry.phrase)):
            self._by_first.setdefault(entry.phrase[0], []).append(entry)

    @cached_property
    def spelling(self) -> Spelling:
        """Forms of the words that begin phrases, and of limbs and sides; built at the first unknown word."""
        return Spelling([*CLOSED, *self._by_first])

    def __contains__(self, base: object) -> bool:
        return base in self._by_first

    def match(self, words: Sequence[Word], start: int) -> tuple[Entry, int] | None:
        """The longest phrase that begins at ``start``, and the index after it; articles inside it are passed over."""
        best: tuple[Entry, int] | None = None
        for base in words[start].bases:
            for entry in self._by_first.get(base, ()):
                if best is not None and len(entry.phrase) <= len(best[0].phrase):
                    break
                end = _end_of(entry.phrase, words, start)
                if end is not None:
                    best = entry, end
                    break
        return best


@lru_cache(maxsize=1)
def limb_spelling() -> Spelling:
    """Forms of limbs, sides and directions alone: after an article nothing else is mended."""
    return Spelling(CLOSED)


def _end_of(phrase: tuple[str, ...], words: Sequence[Word], start: int) -> int | None:
    """The index after ``phrase`` where it stands at ``start``, else None."""
    place = start
    for number, base in enumerate(phrase):
        passed = frozenset() if base in SIDES else ARTICLES if base in PARTICLES else _PASSED | COUNTS
        while number and place < len(words) and words[place].text in passed:
            place += 1
        if place >= len(words) or base not in words[place].bases:
            return None
        place += 1
    return place


@lru_cache(maxsize=4)
def load_lexicon(path: Path = LEXICON_FILE) -> Lexicon:
    """Read a lexicon file, once.

    Raises:
        FormatError: a line that has not three fields, or an unknown code or kind; the message names the line.
    """
    entries: list[Entry] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if line and not line.startswith("#"):
            entries += _entries(path, number, line)
    return Lexicon(entries)


def _entries(path: Path, number: int, line: str) -> list[Entry]:
    fields = line.split("\t")
    if len(fields) != 3 or not set(fields[0]) <= _CODES or fields[1] not in KINDS:
        raise FormatError(path, f"expected parts, kind ({', '.join(KINDS)}) and phrases between tabs", number)
    alone, _, with_thing = fields[0].partition("/")
    phrases = [tuple(phrase.split()) for phrase in fields[2].split(",")]
    return [Entry(phrase, alone, with_thing or alone, fields[1]) for phrase in phrases if phrase]
