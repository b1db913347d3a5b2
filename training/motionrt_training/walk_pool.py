"""Every frame that WalkNet is trained on, in memory: features, contacts, goals, speeds; made once, kept in a file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.lock import planted_toes
from motionrt.motion.rotations import wrapped
from motionrt.motion.transforms import heading as facing_of
from motionrt_training.corpora.bend import smoothed
from motionrt_training.corpora.recordings import Recordings
from motionrt_training.corpora.walks import (
    ROUGH,
    RUNS,
    SIDEWAYS,
    SLOWEST,
    WALKS,
    Variants,
    goal_headings,
    planar_velocity,
    stretches,
    turning,
    variants,
)

OF_RUNS, OF_ROUGH = 0.5, 0.25  # weights
RARE = 3.0  # how much oftener frames are drawn near starts, stops, turns, and where the body looks aside
AHEAD = 30  # frames over which the speed is measured
SOON = 15  # frames over which a stick's wish is to come true


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
        wish: (N, 4) what a stick would have said: velocity (x, z) m/s over the next half second, facing (x, z) at
            its end, of length 1.
        pace: (N,) m/s over the ground at this frame, smoothed.
        aside: (N,) bool, whether the body looks elsewhere than it goes in the next seconds.
    """

    frames: NDArray[np.float32]
    planted: NDArray[np.bool_]
    heading: NDArray[np.float32]
    speed: NDArray[np.float32]
    last: NDArray[np.int64]
    weight: NDArray[np.float32]
    wish: NDArray[np.float32]
    pace: NDArray[np.float32]
    aside: NDArray[np.bool_]

    def starts(self, frames: int) -> NDArray[np.int64]:
        """Every frame that has at least `frames` - 1 more behind it in its stretch."""
        return np.flatnonzero(self.last - np.arange(len(self.last)) >= frames - 1)


def load_or_make(recordings: Recordings, split: str, path: Path) -> WalkPool:
    """The pool of a split, read from `path` if it is there, else made and written there."""
    if not path.is_file():
        motions = list(_varied(recordings, split))
        if not motions:
            raise InvalidInputError(f"nobody walks in the recordings of split '{split}'; WalkNet needs walks in both")
        pool = pool_of(iter(motions))
        np.savez(path, **{field.name: getattr(pool, field.name) for field in fields(pool)})
    return read_pool(path)


def read_pool(path: Path) -> WalkPool:
    """Read what :func:`load_or_make` wrote."""
    with np.load(path) as data:
        return WalkPool(**{name: data[name] for name in data.files})


def pool_of(motions: Iterator[tuple[Motion, float]]) -> WalkPool:
    """Put (motion, weight) into arrays."""
    rows = [_row(motion, weight) for motion, weight in motions]
    lengths = [len(row[0]) for row in rows]
    ends = np.cumsum(lengths) - 1
    frames, planted, heading, speed, *others = (np.concatenate(part) for part in zip(*rows, strict=True))
    return WalkPool(frames, planted, heading, speed, np.repeat(ends, lengths), *others)


def _row(motion: Motion, weight: float) -> tuple[NDArray[Any], ...]:
    """The columns of one motion."""
    pace = np.hypot(*planar_velocity(motion).T)
    floats = (goal_headings(motion), speeds_ahead(motion), weight * interest(motion), wishes(motion), pace)
    heading, speed, *others = (values.astype(np.float32) for values in floats)
    return ccf219.encode(motion), planted_toes(motion), heading, speed, *others, looks_aside(motion)


def wishes(motion: Motion) -> NDArray[np.float64]:
    """(F, 4) velocity (x, z) m/s over the next half second, and where the body faces at its end (x, z)."""
    now = np.arange(motion.frames)
    later = np.minimum(now + SOON, motion.frames - 1)
    now = np.minimum(now, later - 1)
    planar = motion.root[:, [0, 2]].astype(np.float64)
    velocity = (planar[later] - planar[now]) / (later - now)[:, None] * motion.fps
    facing = facing_of(motion)
    faces = smoothed(np.stack([np.sin(facing), np.cos(facing)], axis=1))[later]
    return np.concatenate([velocity, faces / np.linalg.norm(faces, axis=1, keepdims=True)], axis=1)


def looks_aside(motion: Motion) -> NDArray[np.bool_]:
    """(F,) whether in the next two seconds the body goes where it does not look."""
    velocity = planar_velocity(motion)
    off = np.abs(wrapped(np.arctan2(velocity[:, 0], velocity[:, 1]) - facing_of(motion))) > SIDEWAYS
    off &= np.hypot(*velocity.T) > SLOWEST
    counts = np.concatenate([[0], np.cumsum(off)])
    now = np.arange(motion.frames)
    return np.asarray(counts[np.minimum(now + 2 * AHEAD, motion.frames)] - counts[now] > 5)


def interest(motion: Motion) -> NDArray[np.float64]:
    """(F,) how much oftener a frame should be drawn than one of a steady walk."""
    speed, turn = np.hypot(*planar_velocity(motion).T), np.abs(turning(motion))
    later = np.minimum(np.arange(motion.frames) + AHEAD, motion.frames - 1)
    changes = np.abs(speed[later] - speed) > 0.4
    stands = (speed < 0.1) & (turn < 0.2) & (speed[later] < 0.1)
    rare = changes | (turn > 0.8) | looks_aside(motion)
    return np.where(rare, RARE, np.where(stands, 0.7, 1.0))


def speeds_ahead(motion: Motion) -> NDArray[np.float64]:
    """(F,) metres per second over the next second, or over what is left of the motion."""
    planar = motion.root[:, [0, 2]].astype(np.float64)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(planar, axis=0), axis=1))])
    now = np.arange(len(way))
    later = np.minimum(now + AHEAD, len(way) - 1)
    now = np.minimum(now, later - 5)  # the last frames: over the last few
    return np.asarray((way[later] - way[now]) / (later - now) * motion.fps)


def _varied(recordings: Recordings, split: str) -> Iterator[tuple[Motion, float]]:
    rng = np.random.default_rng(7)
    for id_, motion in tqdm(list(stretches(recordings, split)), desc=f"walks of {split}", unit="stretch"):
        for made in variants(motion, _rules(id_, split, rng), rng):
            yield made, OF_ROUGH if id_ in ROUGH else OF_RUNS if id_ in RUNS else 1.0


def _rules(id_: str, split: str, rng: np.random.Generator) -> Variants:
    """None of held-out walks, many of listed ones, few of those found by their motion, which are plenty."""
    if split != "train":
        return Variants(speeds=(), bends=0)
    return Variants() if id_ in WALKS | RUNS else Variants(speeds=(float(rng.uniform(0.85, 1.2)),), bends=1)
