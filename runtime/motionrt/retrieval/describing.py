"""Motion to text: which captions of a list describe a motion best."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from motionrt.motion.attributes import Attributes
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.captions import EmbeddedCaptions
from motionrt.retrieval.scores import top
from motionrt.retrieval.search import checked_k
from motionrt.retrieval.windows import MotionEmbedder, embed_windows, spans_in_seconds

SWING = 0.06
"""What a caption loses where the speed of the feet is against it: kicks and lifted legs are near in the embedding."""

_FAST, _SLOW = 4.2, 3.0
"""m/s about the hip from which on a foot kicks, and up to which none does: 16 kicks reached 4.3 to 6.2, and raised legs
1.9 to 3.4 where they were not thrown up like a kick."""

_KICK = re.compile(r"\bkick", re.IGNORECASE)
_LIFT = re.compile(r"\b(rais|lift)\w*\b(?=.*\b(leg|foot|feet|knee)s?\b)(?!.*\b(arm|hand)s?\b)", re.IGNORECASE)


@dataclass(frozen=True)
class Description:
    """A caption for a motion.

    Attributes:
        rank: 1 is best.
        score: cosine of text and motion, -1 to 1, less what speaks against it.
        text: the caption.
        start_s: where the 10 s window that it fits best starts, seconds.
        end_s: where that window ends.
    """

    rank: int
    score: float
    text: str
    start_s: float
    end_s: float


def describe(
    features: FloatArray,
    duration_s: float,
    captions: EmbeddedCaptions,
    embedder: MotionEmbedder,
    k: int = 5,
    measured: Attributes | None = None,
) -> list[Description]:
    """The ``min(k, N)`` captions nearest to any window of a motion, best first.

    Args:
        features: ``(F, 263)`` of the motion, 20 fps.
        duration_s: its length in seconds.
        captions: the texts to choose from.
        embedder: the motion encoder that belongs to their embeddings.
        k: how many, at least 1.
        measured: of the motion; captions of kicks lose :data:`SWING` where no foot is fast, those of lifted legs where
            one is.
    """
    k = checked_k(k)
    windows, frames = embed_windows(embedder, features)
    spans = spans_in_seconds(frames, duration_s)
    similarity = captions.embeddings @ windows.T  # (N, W)
    if measured is not None:
        similarity = similarity - swing_penalties(captions.texts, measured)[:, None]
    where = similarity.argmax(axis=1)
    found, scores = top(similarity.max(axis=1), k)
    return [
        Description(rank, float(score), captions.texts[i], *spans[int(where[i])])
        for rank, (i, score) in enumerate(zip(found, scores, strict=True), start=1)
    ]


def swing_penalties(texts: Sequence[str], measured: Attributes) -> FloatArray:
    """``(N,)`` what captions lose by the speed of the faster foot."""
    fastest = max(measured.left_foot_peak, measured.right_foot_peak)
    wrong = _LIFT if fastest >= _FAST else _KICK if fastest <= _SLOW else None
    if wrong is None:
        return np.zeros(len(texts), np.float32)
    return np.array([SWING if wrong.search(text) else 0.0 for text in texts], np.float32)
