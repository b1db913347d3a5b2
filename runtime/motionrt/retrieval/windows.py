"""From a motion to the feature windows that the motion encoder sees: 10 s long, every 5 s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import FloatArray

FPS = guo263.FPS
WINDOW_FRAMES = 200
HOP_FRAMES = 100


class MotionEmbedder(Protocol):
    """What a gallery needs of a model."""

    @property
    def name(self) -> str:
        """Which model and variant, for people."""

    @property
    def fingerprint(self) -> str:
        """Checksum of everything that decides an embedding."""

    def embed_motion(self, features: Sequence[FloatArray]) -> FloatArray:
        """Feature windows ``(F, 263)`` -> unit vectors ``(N, 256)`` float32."""


def motion_features(motion: Motion) -> FloatArray:
    """``guo263`` features ``(F, 263)`` of a motion at any frame rate, stood on its floor, at 20 fps.

    Every feature describes one frame and its step to the next: a slice of these describes a part.
    """
    return guo263.encode(motion.grounded().resample(FPS))


def window_spans(frames: int, size: int = WINDOW_FRAMES, hop: int = HOP_FRAMES) -> list[tuple[int, int]]:
    """First and last (exclusive) frame of overlapping windows over ``frames`` frames.

    A clip of at most ``size`` frames is one window; in a longer one the last window ends with the clip.
    """
    if frames <= size:
        return [(0, frames)]
    starts = [*range(0, frames - size, hop), frames - size]
    return [(start, start + size) for start in starts]


def spans_in_seconds(spans: list[tuple[int, int]], duration_s: float) -> list[tuple[float, float]]:
    """Frame spans at 20 fps as seconds of a clip that lasts ``duration_s``."""
    return [(start / FPS, min(end / FPS, duration_s)) for start, end in spans]


def measured(motion: Motion, spans: Sequence[tuple[float, float]]) -> FloatArray:
    """Attributes ``(W, A)`` of the spans of a motion, in the order of :data:`motionrt.motion.attributes.ATTRIBUTES`."""
    joints = motion.positions()
    rows = []
    for start_s, end_s in spans:
        first = min(round(start_s * motion.fps), len(joints) - 1)
        part = joints[first : max(round(end_s * motion.fps), first + 1)]
        rows.append(measure(part, motion.fps).row())
    return np.stack(rows)


def embed_windows(embedder: MotionEmbedder, features: FloatArray) -> tuple[FloatArray, list[tuple[int, int]]]:
    """Embeddings ``(W, 256)`` and frame spans of the windows of one clip's features ``(F, 263)``."""
    spans = window_spans(len(features))
    return embedder.embed_motion([features[start:end] for start, end in spans]), spans


def embed_whole(embedder: MotionEmbedder, features: FloatArray) -> FloatArray:
    """One unit vector ``(256,)`` for a clip of any length: the mean over its windows, normalised."""
    embeddings, _ = embed_windows(embedder, features)
    mean = embeddings.mean(axis=0)
    return np.asarray(mean / max(float(np.linalg.norm(mean)), 1e-12), dtype=np.float32)
