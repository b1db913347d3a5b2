"""Text -> token ids, by the tokenizer that belongs to a model; common words are read without the rest of them."""

from __future__ import annotations

import re
import threading
from functools import cached_property
from typing import TYPE_CHECKING, Any

from motionrt.errors import ManifestError
from motionrt.models.checks import verified
from motionrt.models.sessions import Sessions

if TYPE_CHECKING:
    from tokenizers import Tokenizer

HEAD = 48_000
"""Characters of the vocabulary that are read first, some 3,500 words: the export writes the common ones there."""
_START, _END = '"vocab":{', "}}}"
_NEXT = re.compile(r'\d(,")')


class Tokens:
    """Token ids of texts; may be used from several threads.

    Loading 30,000 words takes a good part of the time to a first answer, and few texts need them. WordPiece takes the
    longest entry that a word begins with, so a word that is an entry of the vocabulary's head is one token, the same,
    with all of it. A text with any other word is read with the whole vocabulary, which is loaded then.
    """

    def __init__(self, sessions: Sessions, model: str) -> None:
        info = sessions.model(model).tokenizer
        if info is None:
            raise ManifestError(
                f"{sessions.manifest.path}: model '{model}' names no tokenizer; export the models again"
            )
        self._manifest, self._info = sessions.manifest, info
        self._lock = threading.RLock()

    def ids(self, text: str) -> list[int]:
        """The ids with the markers of beginning and end, cut at the model's limit."""
        with self._lock:
            head = None if self._is_whole else self._head
        if head is not None and (found := _whole_words(head, text)) is not None:
            return found
        with self._lock:
            whole = self.whole
        return list(whole.encode(text).ids)

    @property
    def _is_whole(self) -> bool:
        """Whether all of the vocabulary is here already."""
        return "whole" in self.__dict__

    def _content(self) -> str:
        return verified(self._manifest, self._info).decode("utf-8")

    @cached_property
    def whole(self) -> Tokenizer:
        """The tokenizer with all of its vocabulary."""
        return _load(self._content(), self._info.max_tokens)

    @cached_property
    def _head(self) -> Tokenizer | None:
        content = head_of(self._content())
        return None if content is None else _load(content, self._info.max_tokens)


def head_of(content: str) -> str | None:
    """A tokenizer file with the first entries of its vocabulary; None where it has few, or is written otherwise."""
    start = content.find(_START)
    cut = _NEXT.search(content, start + HEAD)
    if start < 0 or cut is None or not content.rstrip().endswith(_END):
        return None
    return content[: cut.start(1)] + _END


def _load(content: str, max_tokens: int) -> Tokenizer:
    """Without padding, cutting at the model's limit."""
    from tokenizers import Tokenizer

    tokenizer = Tokenizer.from_str(content)
    tokenizer.no_padding()
    tokenizer.enable_truncation(max_tokens)
    return tokenizer


def _whole_words(tokenizer: Tokenizer, text: str) -> list[int] | None:
    """The ids of a text whose words all are tokens; None for any other."""
    model: Any = tokenizer.model
    found = tokenizer.encode(text)
    if any(token == model.unk_token or token.startswith(model.continuing_subword_prefix) for token in found.tokens):
        return None
    return list(found.ids)
