"""How often: jumps, claps and other repetitions in a text."""

from __future__ import annotations

from typing import Any

from motionrt.text import lexicon as lex
from motionrt.text.patterns import has, matches

Found = dict[str, Any]
SEVERAL = -1


def jumps_of(words: str, found: Found) -> Found:
    """``jumps``: a number, -1 for several, 0 where the action has none."""
    if not has(words, lex.JUMPS):
        return {"jumps": 0} if found["action"] in lex.NO_JUMP_ACTIONS else {}
    count = _count(words)
    if count is not None:
        return {"jumps": count}
    many = has(words, lex.MANY) or has(words, lex.MANY_JUMPS)
    return {"jumps": SEVERAL if many else 1}


def repeats_of(words: str, _found: Found) -> Found:
    """``repeats`` and ``claps``."""
    count = _count(words)
    repeats = count if count is not None else SEVERAL if has(words, lex.MANY) else None
    claps = {"claps": repeats or SEVERAL} if has(words, lex.CLAPS) else {}
    return {"repeats": repeats, **claps}


def _count(words: str) -> int | None:
    found = matches(words, lex.TIMES)
    if not found:
        return None
    match = found[0]
    word = match.group("w") or match.group("n")
    return lex.NUMBERS[word] if word in lex.NUMBERS else int(word)
