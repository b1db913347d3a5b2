"""How often: jumps, claps and other repetitions in a text."""

from __future__ import annotations

from typing import Any

from motionrt.text import lexicon as lex
from motionrt.text.patterns import compiled, has

Found = dict[str, Any]
SEVERAL = -1


def jumps_of(words: str, found: Found) -> Found:
    """``jumps``: a number, -1 for several, 0 where the action has none."""
    if not has(words, lex.JUMPS):
        return {"jumps": 0} if found["action"] in lex.NO_JUMP_ACTIONS else {}
    count = _count(words)
    if count is not None:
        return {"jumps": count}
    many = has(words, lex.MANY) or has(
        words, r"hopping|hops|jacks?\b|bounding|rope|jump\w* (?:around|on the spot|along)\b"
    )
    return {"jumps": SEVERAL if many else 1}


def repeats_of(words: str, _found: Found) -> Found:
    """``repeats`` and ``claps``."""
    count = _count(words)
    repeats = count if count is not None else SEVERAL if has(words, lex.MANY) else None
    claps = {"claps": repeats or SEVERAL} if has(words, lex.CLAPS) else {}
    return {"repeats": repeats, **claps}


def _count(words: str) -> int | None:
    match = compiled(lex.TIMES).search(words)
    if match is None:
        return None
    word = match.group("w") or match.group("n")
    return lex.NUMBERS[word] if word in lex.NUMBERS else int(word)
