"""Letters that a text must hold for a pattern of the parser to match: ``_assets/text_triggers.json``.

    python -m motionrt_export.triggers          # write it again, after the lexicon changed

With it most patterns are not even compiled for most texts; without it the parser answers the same, but slower.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from motionrt.text import lexicon
from motionrt.text.lexicon.gestures import Gesture, HeadGesture
from motionrt.text.patterns import TRIGGERS_FILE, groups_of_words, key

_NO_PATTERNS = frozenset({"GROUPS", "NUMBERS", "MOVES"})
_LOOKS_LIKE_ONE = re.compile(r"[\\(|{?]")
_SHORTEST = 2  # letters of a trigger
_TOKEN = re.compile(
    r"\\."  # an escape: a boundary or a class of letters
    r"|\{\d*,?\d*\}[?+]?|[*+?]\??"  # how often the last item comes
    r"|\{[a-z]\w*\}"  # a group of the lexicon
    r"|\(\?(?::|P<\w+>|!|<!|=|<=)|\(|\)|\[\^?\]?[^\]]*\]|\||\^|\$|\.|."
)
Triggers = frozenset[str] | None


def main() -> None:
    """Write the triggers of every pattern of the lexicon."""
    Path(TRIGGERS_FILE).write_text(json.dumps(made(), indent=0, sort_keys=True) + "\n", encoding="ascii")


def made() -> dict[str, list[str]]:
    """Key of a pattern -> its triggers, for all that have some."""
    found = {pattern: triggers(pattern, groups_of_words()) for pattern in patterns()}
    return {key(pattern): sorted(letters) for pattern, letters in found.items() if letters is not None}


def patterns() -> list[str]:
    """Every pattern of the lexicon."""
    tables = [value for name, value in vars(lexicon).items() if name.isupper() and name not in _NO_PATTERNS]
    return sorted({text for table in tables for text in _texts(table) if _LOOKS_LIKE_ONE.search(text)})


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from (text for part in value.values() for text in _texts(part))
    elif isinstance(value, tuple | list):
        yield from (text for part in value for text in _texts(part))
    elif isinstance(value, Gesture | HeadGesture):
        yield value.pattern


def triggers(pattern: str, groups: Mapping[str, str]) -> Triggers:
    """Strings of which a text must hold at least one where the pattern is to match; None where any text may match.

    Args:
        pattern: of literals, groups, classes of letters, boundaries and quantifiers.
        groups: what ``{name}`` stands for.
    """
    return _alternatives(_Reader(pattern, groups))


class _Reader:
    """The tokens of a pattern, one after another."""

    def __init__(self, pattern: str, groups: Mapping[str, str]) -> None:
        self.tokens: Iterator[str] = (match.group() for match in _TOKEN.finditer(pattern))
        self.groups = groups
        self.ahead: str | None = next(self.tokens, None)

    def take(self) -> str:
        token, self.ahead = self.ahead or "", next(self.tokens, None)
        return token

    def repeated(self) -> str:
        """The quantifier behind the last item, or nothing."""
        token = self.ahead or ""
        return self.take() if token[:1] in "*+?" and token else self.take() if re.match(r"\{\d", token) else ""


def _alternatives(reader: _Reader) -> Triggers:
    found: set[str] = set()
    open_ended = False
    while True:
        best = _sequence(reader)
        open_ended |= best is None
        found |= best or frozenset()
        if reader.ahead != "|":
            break
        reader.take()
    return None if open_ended else frozenset(found)


def _sequence(reader: _Reader) -> Triggers:
    """The best triggers of one alternative, up to ``|``, ``)`` or the end."""
    best: Triggers = None
    run = ""
    while reader.ahead is not None and reader.ahead not in ("|", ")"):
        token = reader.take()
        if len(token) == 1 and (token.isalnum() or token in " '"):
            often = reader.repeated()
            maybe = often[:1] in ("*", "?") or often.startswith("{0")
            if not often:
                run += token
                continue
            best = _better(best, run if maybe else run + token)
        else:
            best = _better(best, run)
            best = _item(reader, token, best)
        run = ""
    return _better(best, run)


def _item(reader: _Reader, token: str, best: Triggers) -> Triggers:
    """The best triggers after an item that is no literal."""
    inner: Triggers = None
    if token.startswith("("):
        inner = _alternatives(reader)
        reader.take()  # ")"
        if token in ("(?!", "(?<!"):
            inner = None
    elif token[0] == "{" and token[1:-1] in reader.groups:
        inner = triggers(reader.groups[token[1:-1]], reader.groups)
    often = reader.repeated()
    if inner is None or often[:1] in ("*", "?") or often.startswith("{0"):
        return best
    return inner if best is None or min(map(len, inner)) > min(map(len, best)) else best


def _better(best: Triggers, run: str) -> Triggers:
    """The longer of what was found and a run of letters."""
    if len(run.strip()) < _SHORTEST:
        return best
    return frozenset({run}) if best is None or len(run) > min(map(len, best)) else best


if __name__ == "__main__":
    main()
