"""Moments: where in a long motion a text happens  [TMR 4.5]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.metrics import temporal_iou
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.search import checked_k
from motionrt.retrieval.windows import FPS, MotionEmbedder, span_features
from motionrt.untrusted.arguments import checked_number, checked_whole, listed

WINDOW_LENGTHS = (10, 20, 30, 40, 50, 60)
STRIDE = 5
MAX_OVERLAP = 0.3


FITS = 0.45
"""Cosine from which on a span fits. Of 40 starter clips 90 % reach it somewhere with their own text, 10 % with that of
another clip; and 45 % of motions of six clips with a text of none of them."""


@dataclass(frozen=True)
class Moment:
    """A span of a motion that fits a text.

    Attributes:
        rank: 1 is best.
        score: cosine of text and span, -1 to 1.
        start_s: first moment of the span, seconds.
        end_s: its end.
    """

    rank: int
    score: float
    start_s: float
    end_s: float


@dataclass(frozen=True, eq=False)
class Moments:
    """The best spans, and how the text fits over time.

    Attributes:
        best: spans that overlap little, best first.
        curve: ``(F,)`` float32, at every frame the mean cosine of the windows that cover it.
        fps: frames per second of the curve.
    """

    best: list[Moment]
    curve: FloatArray
    fps: float = FPS


def find_moments(
    text_embedding: FloatArray,
    features: FloatArray,
    embedder: MotionEmbedder,
    k: int = 5,
    *,
    lengths: Sequence[int] = WINDOW_LENGTHS,
    stride: int = STRIDE,
    max_overlap: float = MAX_OVERLAP,
    min_score: float | None = None,
) -> Moments:
    """Slide windows of several lengths over a motion and keep the best that do not repeat each other.

    Args:
        text_embedding: ``(256,)`` unit vector.
        features: ``(F, 263)`` of the motion, 20 fps.
        embedder: the motion encoder that belongs to the text's.
        k: how many spans at most, at least 1.
        lengths: window lengths in frames.
        stride: frames from window to window.
        max_overlap: temporal IoU with a better span from which on a span is dropped.
        min_score: only spans whose cosine with the text is at least this, -1 to 1; None takes all.

    Raises:
        InvalidInputError: a number out of its range.
    """
    k = checked_k(k)
    if min_score is not None:
        min_score = checked_number(min_score, "min_score", -1.0, 1.0)
    spans = pyramid(len(features), lengths, stride)
    scores = embedder.embed_motion(span_features(features, spans.tolist())) @ text_embedding
    kept = non_maximum_suppression(spans, scores, max_overlap)[:k]
    best = [
        Moment(rank, float(scores[i]), float(spans[i, 0] / FPS), float(spans[i, 1] / FPS))
        for rank, i in enumerate(kept, start=1)
        if min_score is None or scores[i] >= min_score
    ]
    return Moments(best, similarity_curve(spans, scores, len(features)))


def pyramid(frames: int, lengths: Sequence[int] = WINDOW_LENGTHS, stride: int = STRIDE) -> npt.NDArray[np.int64]:
    """Windows ``(W, 2)`` of all lengths, first and last (exclusive) frame, short lengths first.

    The last window of a length ends with the motion. A motion shorter than the shortest length is one window.
    """
    wanted = {checked_whole(length, "a window's length", 1) for length in listed(lengths, "lengths", "frames")}
    if not wanted or stride < 1:
        raise InvalidInputError("moments need window lengths and a stride of at least one frame")
    spans = [
        (start, start + length)
        for length in sorted(wanted)
        if length <= frames
        for start in [*range(0, frames - length, stride), frames - length]
    ]
    return np.array(spans or [(0, frames)], dtype=np.int64)


def non_maximum_suppression(
    spans: npt.NDArray[np.int64], scores: FloatArray, max_overlap: float = MAX_OVERLAP
) -> list[int]:
    """Indices of spans, best first, without those that overlap a better one by ``max_overlap`` or more."""
    order = np.argsort(-scores, kind="stable")
    kept: list[int] = []
    while len(order):
        kept.append(int(order[0]))
        order = order[temporal_iou(spans[order], spans[order[0]]) < max_overlap]
        order = order[order != kept[-1]]
    return kept


def similarity_curve(spans: npt.NDArray[np.int64], scores: FloatArray, frames: int) -> FloatArray:
    """Mean score of the windows over each frame, ``(F,)``."""
    total, count = np.zeros(frames + 1), np.zeros(frames + 1)
    for ends, sign in ((spans[:, 0], 1.0), (spans[:, 1], -1.0)):
        np.add.at(total, ends, sign * scores)
        np.add.at(count, ends, sign)
    covered = np.cumsum(total)[:frames] / np.maximum(np.cumsum(count)[:frames], 1)
    return np.asarray(covered, dtype=np.float32)
