"""Moment retrieval on long recordings, against the annotated segments  [TMR 4.5].

Every recording that its annotation cuts into two or more segments is searched with the captions of each segment; the
best span that comes back is compared with the segment.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.metrics import localisation_accuracy, temporal_iou
from motionrt.metrics.temporal import THRESHOLDS
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.moments import find_moments
from motionrt.retrieval.windows import motion_features
from motionrt_training.corpora import Clip, MotionCorpus
from motionrt_training.evaluate.embedders import Embedder


@dataclass(frozen=True)
class MomentRow:
    """Temporal-IoU accuracy in percent at each threshold, the mean IoU, and how many queries on how many recordings."""

    accuracy: dict[float, float]
    mean_iou: float
    queries: int
    recordings: int


def evaluate_moments(
    embedder: Embedder,
    corpus: MotionCorpus,
    lengths: Sequence[int],
    *,
    style: int = 1,
    chance: bool = False,
    thresholds: Sequence[float] = THRESHOLDS,
) -> MomentRow:
    """Search every long recording of ``corpus`` for its segments with windows of ``lengths`` frames at 20 fps.

    ``chance`` replaces the texts by those of the recording's other segments, which shows what a wrong text finds.

    Raises:
        InvalidInputError: no recording has two segments or more.
    """
    found, truth = [], []
    recordings = _long_recordings(corpus)
    for path, segments in recordings.items():
        recording = corpus.loader(path)
        features = motion_features(recording)
        captions = [clip.texts[style % len(clip.texts)] for clip in segments]
        shift, windows = int(chance), _Remembering(embedder)
        for clip, text in zip(segments, embedder.embed_text(captions[shift:] + captions[:shift]), strict=True):
            found.append(_best_span(windows, features, text, lengths))
            truth.append((clip.start_s, recording.duration if clip.end_s is None else clip.end_s))
    if not found:
        raise InvalidInputError(f"no recording of {corpus.name} has two annotated segments; name another split")
    return MomentRow(
        localisation_accuracy(found, truth, thresholds),
        float(temporal_iou(found, truth).mean()),
        len(found),
        len(recordings),
    )


def _best_span(
    windows: _Remembering, features: FloatArray, text: FloatArray, lengths: Sequence[int]
) -> tuple[float, float]:
    best = find_moments(text, features, windows, k=1, lengths=lengths).best[0]
    return best.start_s, best.end_s


def _long_recordings(corpus: MotionCorpus) -> dict[Path, list[Clip]]:
    grouped: dict[Path, list[Clip]] = defaultdict(list)
    for clip in corpus.clips:
        grouped[clip.path].append(clip)
    return {path: clips for path, clips in grouped.items() if len(clips) > 1}


class _Remembering:
    """The windows of one recording are the same for every text: embed them once."""

    def __init__(self, embedder: Embedder) -> None:
        self._embedder, self._rows = embedder, np.zeros((0, 0), np.float32)

    def embed_motion(self, features: Sequence[FloatArray]) -> FloatArray:
        if len(self._rows) != len(features):
            self._rows = self._embedder.embed_motion(features)
        return self._rows
