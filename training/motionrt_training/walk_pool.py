"""Every frame that WalkNet is trained on, in memory: features, contacts, goals, speeds; made once, kept in a file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.lock import planted_toes
from motionrt_training.corpora.recordings import Recordings
from motionrt_training.corpora.walks import ROUGH, RUNS, Variants, goal_headings, stretches, variants

OF_RUNS, OF_ROUGH = 0.5, 0.25  # weights
AHEAD = 30  # frames over which the speed is measured


@dataclass(frozen=True, eq=False)
class WalkPool:
    """Stretches one behind the other; N frames in all.

    Attributes:
        frames: (N, 219) `ccf219` in the frame of each recording.
        planted: (N, 2) bool, left and right toe.
        heading: (N,) the heading of a goal at this frame.
        speed: (N,) m/s over the next second.
        last: (N,) the last frame of the stretch that a frame belongs to.
        weight: (N,) how often a frame is drawn, against those of plain walks.
    """

    frames: NDArray[np.float32]
    planted: NDArray[np.bool_]
    heading: NDArray[np.float32]
    speed: NDArray[np.float32]
    last: NDArray[np.int64]
    weight: NDArray[np.float32]

    def starts(self, frames: int) -> NDArray[np.int64]:
        """Every frame that has at least `frames` - 1 more behind it in its stretch."""
        return np.flatnonzero(self.last - np.arange(len(self.last)) >= frames - 1)


def load_or_make(recordings: Recordings, split: str, path: Path) -> WalkPool:
    """The pool of a split, read from `path` if it is there, else made and written there."""
    if not path.is_file():
        rules = Variants() if split == "train" else Variants(speeds=(), bends=0)
        pool = pool_of(_varied(recordings, split, rules))
        np.savez(path, **{field.name: getattr(pool, field.name) for field in fields(pool)})
    return read_pool(path)


def read_pool(path: Path) -> WalkPool:
    """Read what :func:`load_or_make` wrote."""
    with np.load(path) as data:
        return WalkPool(**{name: data[name] for name in data.files})


def pool_of(motions: Iterator[tuple[Motion, float]]) -> WalkPool:
    """Put (motion, weight) into arrays."""
    rows = [(ccf219.encode(m), planted_toes(m), goal_headings(m), speeds_ahead(m), weight) for m, weight in motions]
    lengths = [len(row[0]) for row in rows]
    ends = np.cumsum(lengths) - 1
    return WalkPool(
        np.concatenate([row[0] for row in rows]),
        np.concatenate([row[1] for row in rows]),
        np.concatenate([row[2] for row in rows]).astype(np.float32),
        np.concatenate([row[3] for row in rows]).astype(np.float32),
        np.repeat(ends, lengths),
        np.repeat([row[4] for row in rows], lengths).astype(np.float32),
    )


def speeds_ahead(motion: Motion) -> NDArray[np.float64]:
    """(F,) metres per second over the next second, or over what is left of the motion."""
    planar = motion.root[:, [0, 2]].astype(np.float64)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(planar, axis=0), axis=1))])
    now = np.arange(len(way))
    later = np.minimum(now + AHEAD, len(way) - 1)
    now = np.minimum(now, later - 5)  # the last frames: over the last few
    return np.asarray((way[later] - way[now]) / (later - now) * motion.fps)


def _varied(recordings: Recordings, split: str, rules: Variants) -> Iterator[tuple[Motion, float]]:
    rng = np.random.default_rng(7)
    for id_, motion in tqdm(list(stretches(recordings, split)), desc=f"walks of {split}", unit="stretch"):
        for made in variants(motion, rules, rng):
            yield made, OF_ROUGH if id_ in ROUGH else OF_RUNS if id_ in RUNS else 1.0
