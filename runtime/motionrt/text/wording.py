"""``worded``: a text in the plain words that the lexicon knows, whatever words somebody has for it."""

from __future__ import annotations

from functools import lru_cache

from motionrt.text import lexicon as lex
from motionrt.text.patterns import compiled, may_match, plain
from motionrt.text.spelling import mended


@lru_cache(maxsize=4096)
def worded(text: str) -> str:
    """Lower case, slips of the pen mended, other people's words replaced by plain ones."""
    words = mended(plain(text))
    for pattern, instead in lex.WORDING:
        if may_match(words, pattern):
            words = compiled(pattern).sub(instead.replace("$", "\\"), words)
    return " ".join(words.split())


def network_text(text: str) -> str:
    """What a network reads of a text: the text itself where all of its words are plain, else the plain words for it."""
    words = worded(text)
    return text if words == plain(text) else words
