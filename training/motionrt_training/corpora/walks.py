"""The walks and runs among the recordings, and what WalkNet is trained on: many variants of each.

Of CMU's recordings those are taken that are listed, of all others those whose motion says so. A stretch is kept where
the person moves over the ground or turns on the spot, upright, arms low, with seconds around it so that starts, stops
and standing are seen, and brought onto flat ground. Which way it looks is free: there are backward and sideways
walks. Each also comes mirrored, at other speeds and along other paths; planted feet are held.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.flat_ground import flat_ground
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.rotations import Array, wrapped
from motionrt.motion.transforms import heading
from motionrt_training.corpora.bend import bent, smoothed, wave
from motionrt_training.corpora.recordings import FPS, Recordings


def _listed(name: str) -> frozenset[str]:
    """Recordings listed in a file beside this one."""
    lines = Path(__file__).with_name(name).read_text(encoding="utf-8").splitlines()
    return frozenset(id_ for line in lines if not line.startswith("#") for id_ in line.split())


WALKS, RUNS = _listed("walks.txt"), _listed("runs.txt")
NOT_PLAIN = tuple(sorted(_listed("not_plain.txt")))
ROUGH = frozenset({"jl_walk_run_turns", "jl_walk_run_short"})  # three times the jerk of the others, sliding feet
SLOWEST = 0.3  # m/s: slower is standing
SIDEWAYS = 0.8  # rad between heading and way: more is a side step
LOWEST, HIGHEST = 0.75, 1.1  # metres of the pelvis
UPRIGHT = 0.85  # cosine of the trunk's lean
MARGIN = 30  # frames around a stretch
SHORTEST = 40  # frames of a stretch
SLOW, TURNING = 0.12, 0.6  # m/s and rad/s: less of both is standing
CALM_S = 1.5  # seconds of standing around a stretch that are kept
ARMS_LOW = 0.05  # metres that wrists stay below the neck
FLIGHT = 0.2  # metres of both toes: higher is a jump
FASTEST = 6.5  # m/s between frames: faster is a fault of the recording


@dataclass(frozen=True)
class Variants:
    """How many variants of each stretch are made."""

    speeds: tuple[float, ...] = (0.88, 1.12)
    bends: int = 2
    strongest: float = 0.8  # rad/m


def stretches(recordings: Recordings, split: str) -> Iterator[tuple[str, Motion]]:
    """(id, motion) of every stretch of locomotion of a split."""
    for id_, motion in recordings.split(split):
        if id_ in WALKS or id_ in RUNS:
            for part in locomotion_parts(motion):
                yield id_, flat_ground(part)
        elif "/" in id_ and not id_.startswith(NOT_PLAIN):  # of the second delivery, or of any other corpus
            for part in free_parts(motion):
                yield id_, flat_ground(part)


def locomotion_parts(motion: Motion) -> list[Motion]:
    """The stretches of a recording in which the person walks or runs looking where it goes."""
    return _parts(motion, moves_on(motion), MARGIN)


def free_parts(motion: Motion) -> list[Motion]:
    """The stretches in which the person goes any way, or turns on the spot, and the standing around them."""
    upright = stands_upright(motion)
    steps = np.hypot(*planar_velocity(motion).T) > SLOW
    moving = (steps | (np.abs(turning(motion)) > TURNING)) & upright
    margin = round(CALM_S * motion.fps)
    whole = _parts(motion, moving, margin)
    return [part for part in whole if stands_upright(part).mean() > 0.98 and _plausible(part)]


def _parts(motion: Motion, moving: Array, margin: int) -> list[Motion]:
    edges = np.flatnonzero(np.diff(np.pad(moving, 1).astype(np.int8)))
    spans = [(max(0, a - margin), min(motion.frames, b + margin)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    return [motion[a:b] for a, b in _joined(spans) if b - a >= SHORTEST]


def stands_upright(motion: Motion) -> Array:
    """(F,) bool: trunk upright, pelvis level, wrists below the neck, at least one foot near the ground."""
    positions, height = motion.positions(), motion.root[:, 1]
    trunk = positions[:, SMPL24.index("neck")] - positions[:, 0]
    upright = trunk[:, 1] > UPRIGHT * np.linalg.norm(trunk, axis=1)
    wrists = positions[:, [SMPL24.index("left_wrist"), SMPL24.index("right_wrist")], 1].max(axis=1)
    low = wrists < positions[:, SMPL24.index("neck"), 1] - ARMS_LOW
    toes = positions[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")], 1].min(axis=1)
    level = (height > LOWEST) & (height < HIGHEST)
    return np.asarray(upright & low & level & (toes < FLIGHT))


def turning(motion: Motion) -> Array:
    """(F,) rad/s of the pelvis' heading, smoothed over half a second."""
    yaw = np.unwrap(heading(motion))
    return smoothed(np.diff(yaw, prepend=yaw[:1])[:, None])[:, 0] * motion.fps


def _plausible(motion: Motion) -> bool:
    """No frame that leaps."""
    steps = np.linalg.norm(np.diff(motion.root, axis=0), axis=1) * motion.fps
    return bool(steps.max(initial=0.0) < FASTEST)


def moves_on(motion: Motion) -> Array:
    """(F,) bool: over the ground, upright, looking where it goes."""
    velocity = planar_velocity(motion)
    way = np.arctan2(velocity[:, 0], velocity[:, 1])
    aside = np.abs(wrapped(way - heading(motion)))
    positions, height = motion.positions(), motion.root[:, 1]
    trunk = positions[:, SMPL24.index("neck")] - positions[:, 0]
    upright = trunk[:, 1] > UPRIGHT * np.linalg.norm(trunk, axis=1)
    level = (height > LOWEST) & (height < HIGHEST)
    return (np.hypot(*velocity.T) > SLOWEST) & (aside < SIDEWAYS) & level & upright


def planar_velocity(motion: Motion) -> Array:
    """(F, 2) m/s of the pelvis over the ground, smoothed over half a second."""
    planar = motion.root[:, [0, 2]]
    return smoothed(np.diff(planar, axis=0, prepend=planar[:1])) * motion.fps


def variants(motion: Motion, rules: Variants, rng: np.random.Generator) -> Iterator[Motion]:
    """The stretch and its variants, each also mirrored; planted feet are held."""
    warped = [resped(motion, speed) for speed in rules.speeds]
    curves = [bent(motion, wave(motion.frames, rng, rules.strongest)) for _ in range(rules.bends)]
    for made in (motion, *warped, *curves):
        locked = lock_feet(made)
        yield locked
        yield locked.mirror()


def resped(motion: Motion, speed: float) -> Motion:
    """Played ``speed`` times as fast."""
    return replace(replace(motion, fps=FPS * speed).resample(FPS), fps=FPS)


def goal_headings(motion: Motion) -> Array:
    """(F,) radians: the way where it moves, else where the body faces; smoothed."""
    velocity = planar_velocity(motion)
    facing = heading(motion)
    faced = smoothed(np.stack([np.sin(facing), np.cos(facing)], axis=1))
    aim = np.where(np.hypot(*velocity.T)[:, None] > SLOWEST, velocity, faced)
    return np.arctan2(aim[:, 0], aim[:, 1])


def features(motion: Motion) -> Array:
    """(F, 219) float32."""
    return ccf219.encode(motion)


def _joined(spans: list[tuple[int, int]]) -> list[tuple[int, int]]:
    out: list[tuple[int, int]] = []
    for first, last in spans:
        if out and first <= out[-1][1]:
            out[-1] = (out[-1][0], last)
        else:
            out.append((first, last))
    return out
