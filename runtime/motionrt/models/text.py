"""Text -> token features and sentence embedding, with the tokenizer that belongs to the model."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, ManifestError
from motionrt.limits import how_to_raise, limits
from motionrt.models.checks import verified
from motionrt.models.sessions import Sessions
from motionrt.untrusted.words import shown

if TYPE_CHECKING:
    from tokenizers import Tokenizer

FloatArray = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.int64]

MODEL = "tmr_text"
EMBED = "embed"
"""Input of the model; false leaves out what only a search needs."""


@dataclass(frozen=True, eq=False)
class SentenceFeatures:
    """What the sentence encoder says of one text of ``T`` tokens.

    Attributes:
        token_features: ``(1, T, 384)`` float32, one row per token.
        attention_mask: ``(1, T)`` int64, all ones.
        sentence_embedding: ``(384,)`` float32, unit length.
    """

    token_features: FloatArray
    attention_mask: IntArray
    sentence_embedding: FloatArray


class SentenceEncoder:
    """The frozen sentence encoder, the first part of the text model.

    Texts go in one by one: features never depend on neighbours.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self._sessions, self._variant = sessions, variant
        self._tokenizer: Tokenizer | None = None
        self._lock = threading.Lock()

    def tokens(self, text: str) -> IntArray:
        """Token ids ``(T,)`` with the markers of beginning and end, cut at the model's limit.

        Raises:
            InvalidInputError: not a string, or nothing but white space.
        """
        return np.array(self._open_tokenizer().encode(checked_text(text)).ids, dtype=np.int64)

    def feeds(self, text: str) -> dict[str, IntArray]:
        """What the model is given for one text; raises as `tokens` does."""
        ids = self.tokens(text)[None]
        return {"input_ids": ids, "attention_mask": np.ones_like(ids)}

    def encode(self, text: str) -> SentenceFeatures:
        """Features of one text; raises as `tokens` does."""
        feeds = self.feeds(text)
        names = ["token_features", "sentence_embedding"]
        features, sentence = self._sessions.run(MODEL, names, {**feeds, EMBED: np.array(False)}, self._variant)
        return SentenceFeatures(features, feeds["attention_mask"], sentence[0])

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Unit sentence embeddings ``(N, 384)``; raises as `tokens` does."""
        checked = checked_texts(texts)
        rows = [self.encode(text).sentence_embedding for text in checked]
        return np.stack(rows) if rows else np.zeros((0, 384), np.float32)

    def _open_tokenizer(self) -> Tokenizer:
        with self._lock:
            if self._tokenizer is None:
                self._tokenizer = load_tokenizer(self._sessions)
            return self._tokenizer


def load_tokenizer(sessions: Sessions, model: str = MODEL) -> Tokenizer:
    """The tokenizer of a text model, checked, without padding, cutting at the model's limit."""
    from tokenizers import Tokenizer

    info = sessions.model(model).tokenizer
    if info is None:
        raise ManifestError(f"{sessions.manifest.path}: model '{model}' names no tokenizer; export the models again")
    tokenizer = Tokenizer.from_str(verified(sessions.manifest, info).decode("utf-8"))
    tokenizer.no_padding()
    tokenizer.enable_truncation(info.max_tokens)
    return tokenizer


def checked_texts(texts: Sequence[str]) -> list[str]:
    """Every text checked; a single string instead of a list is refused, as its letters would become texts."""
    if isinstance(texts, str | bytes):
        raise InvalidInputError(f"expected a list of texts, found one text; give [{shown(texts)}]")
    if not isinstance(texts, Iterable):
        raise InvalidInputError(f"expected a list of texts, not {shown(texts)}")
    return [checked_text(text) for text in texts]


def checked_text(text: object) -> str:
    """``text`` itself; InvalidInputError unless it is a string with something in it."""
    if not isinstance(text, str):
        raise InvalidInputError(f"a text must be a str, not {type(text).__name__} ({shown(text)})")
    if len(text) > limits().text_chars:
        raise InvalidInputError(f"the text has {len(text):,} characters: {how_to_raise('text_chars')}")
    if any("\ud800" <= character <= "\udfff" for character in text):
        raise InvalidInputError(f"the text holds half a character (a lone surrogate): {shown(text)}")
    if not text.strip():
        raise InvalidInputError("the text is empty; describe a motion, such as 'a person walks in a circle'")
    return text
