"""Motion to text: which captions of a list describe a motion best."""

from __future__ import annotations

from dataclasses import dataclass

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.captions import EmbeddedCaptions
from motionrt.retrieval.scores import top
from motionrt.retrieval.search import checked_k
from motionrt.retrieval.windows import MotionEmbedder, embed_windows, spans_in_seconds


@dataclass(frozen=True)
class Description:
    """A caption for a motion.

    Attributes:
        rank: 1 is best.
        score: cosine of text and motion, -1 to 1.
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
) -> list[Description]:
    """The ``min(k, N)`` captions nearest to any window of a motion, best first.

    Args:
        features: ``(F, 263)`` of the motion, 20 fps.
        duration_s: its length in seconds.
        captions: the texts to choose from.
        embedder: the motion encoder that belongs to their embeddings.
        k: how many, at least 1.
    """
    k = checked_k(k)
    windows, frames = embed_windows(embedder, features)
    spans = spans_in_seconds(frames, duration_s)
    similarity = captions.embeddings @ windows.T  # (N, W)
    where = similarity.argmax(axis=1)
    found, scores = top(similarity.max(axis=1), k)
    return [
        Description(rank, float(score), captions.texts[i], *spans[int(where[i])])
        for rank, (i, score) in enumerate(zip(found, scores, strict=True), start=1)
    ]
