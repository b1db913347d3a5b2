"""Recordings cut into the clips that a search model is trained on: captioned segments, and what lies between them."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, RigError
from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt_training.corpora.corpus import Clip
from motionrt_training.corpora.mocap import Recording, Segment
from motionrt_training.wording.measured import say_measured

LONGEST_S, SHORTEST_S = 8.0, 2.0  # of stretches without captions
SPOKEN = 4  # sentences on a stretch without captions

log = logging.getLogger(__name__)


def recorded_clips(recordings: Iterable[Recording], seed: int = 1) -> Iterator[tuple[Clip, Motion]]:
    """Every captioned segment with its motion; of training recordings also the rest, told by what is measured."""
    rng = np.random.default_rng(seed)
    for recording in recordings:
        try:
            motion = recording.load()
        except (FormatError, RigError) as error:
            log.warning("left out: %s: %s", recording.id, error)
            continue
        for segment in recording.segments:
            yield _captioned(recording, segment), motion.between(segment.start_s, segment.end_s)
        if recording.split == "train" and not recording.id.endswith(SECOND):
            yield from _untold(recording, motion, rng)


SECOND = "@amc"  # ends the id of the second file of a recording


def take_pairs(recordings: Sequence[Recording], folder: Path) -> list[Recording]:
    """The recordings of ``folder/pairs``, which hold trials of ``folder/bvh`` a second time, as ``.amc``."""
    found = []
    for recording in recordings:
        path = folder / "pairs" / f"{recording.id}.amc"
        if recording.source == "cmu" and recording.split == "train" and path.is_file():
            skeleton = folder / "asf" / f"{recording.id.split('_')[0]}.asf"
            found.append(replace(recording, id=recording.id + SECOND, path=path, asf=skeleton, fps=60.0))
    return found


def _captioned(recording: Recording, segment: Segment) -> Clip:
    second = SECOND if recording.id.endswith(SECOND) else ""
    labels = tuple(text for text, _ in segment.labels)
    return Clip(
        segment.id + second, recording.path, segment.start_s, segment.end_s, segment.captions, recording.split, labels,
        group=segment.id, source=recording.source,
    )  # fmt: skip


def _untold(recording: Recording, motion: Motion, rng: np.random.Generator) -> Iterator[tuple[Clip, Motion]]:
    for start, end in _gaps(recording.segments, motion.duration):
        part = motion.between(start, end)
        texts = say_measured(measure(part), rng, SPOKEN)
        if texts:
            id_ = f"{recording.id}#{start:.1f}"
            yield Clip(id_, recording.path, start, end, tuple(texts), "train", source=recording.source), part


def _gaps(segments: Sequence[Segment], seconds: float) -> Iterator[tuple[float, float]]:
    """Stretches of at most 8 s that no caption speaks of."""
    ends = [0.0, *(segment.end_s for segment in segments)]
    starts = [*(segment.start_s for segment in segments), seconds]
    for first, last in zip(ends, starts, strict=True):
        for start in np.arange(first, last - SHORTEST_S + 1e-9, LONGEST_S).tolist():
            yield start, min(start + LONGEST_S, last)
