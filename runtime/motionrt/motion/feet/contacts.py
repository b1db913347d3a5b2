"""When the feet stand: contacts from the heights and speeds of toes and ankles.

A joint is in contact while it is low and slow. Both tests have a strict and a loose threshold (hysteresis): a stretch
of loosely good frames counts when at least one of them is strictly good. The rule looks the same way forwards and
backwards, so a motion and its reverse have the same contacts.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.features import guo263
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.runs import BoolArray, Runs
from motionrt.motion.skeleton import Skeleton

CONTACT_JOINTS = ("left_ankle", "left_foot", "right_ankle", "right_foot")  # the order of guo263's contacts
LOOSE_SPEED = float(guo263.CONTACT_SPEED) * guo263.FPS  # 0.89 m/s, the speed below which guo263 sees a contact
STRICT_SPEED = LOOSE_SPEED / 2
STRICT_HEIGHT, LOOSE_HEIGHT = 0.06, 0.09  # metres above the joint's height in a flat standing foot
SHORTEST_S = 0.07  # shorter contacts, and shorter gaps between contacts, are flickers
_SPEED_SPAN_S = 1 / 30  # speeds are central differences over this much time to either side


def foot_contacts(motion: Motion, floor: float = 0.0) -> BoolArray:
    """``(F, 2)``: whether the left and the right foot stands, on its heel (ankle) or its ball (toe joint).

    Args:
        motion: any frame rate (made for 20 to 120 fps).
        floor: height in metres of the toe joint of a standing foot: 0 after :meth:`Motion.grounded`.
    """
    found = joint_contacts(motion, floor)
    return np.stack([found[:, :2].any(axis=1), found[:, 2:].any(axis=1)], axis=1)


def toe_contacts(motion: Motion, floor: float = 0.0, slower: float = 1.0) -> BoolArray:
    """``(F, 2)``: whether the ball of the left and right foot stands still; ``slower`` scales the speeds allowed."""
    toes = motion.positions()[:, [motion.skeleton.index(name) for name in CONTACT_JOINTS[1::2]]]
    return still(toes[..., 1] - floor, speeds(toes, motion.fps) / slower, motion.fps)


def joint_contacts(motion: Motion, floor: float = 0.0) -> BoolArray:
    """``(F, 4)``: contacts of left ankle, left toe, right ankle and right toe."""
    points = motion.positions()[:, [motion.skeleton.index(name) for name in CONTACT_JOINTS]]
    height = points[..., 1] - floor - standing_heights(motion.skeleton)
    return still(height, speeds(points, motion.fps), motion.fps)


def still(height: Array, speed: Array, fps: float) -> BoolArray:
    """``(F, N)``: the contacts of points by height above where they stand, metres, and speed, m/s."""
    strict = (speed < STRICT_SPEED) & (height < STRICT_HEIGHT)
    loose = (speed < LOOSE_SPEED) & (height < LOOSE_HEIGHT)
    return _without_flickers(hysteresis(strict, loose), max(2, round(SHORTEST_S * fps)))


def standing_heights(skeleton: Skeleton) -> Array:
    """``(4,)``: heights of the contact joints above the toe joint while a foot stands flat, metres."""
    left = [skeleton.rest_positions[skeleton.index(name), 1] for name in CONTACT_JOINTS]
    toes = np.repeat(np.array(left)[[1, 3]], 2)
    return np.asarray(np.array(left) - toes, dtype=np.float32)


def speeds(points: Array, fps: float) -> Array:
    """``(F, N)`` metres per second of points ``(F, N, 3)``: central differences over about 1/15 s at any rate."""
    half = max(1, round(_SPEED_SPAN_S * fps))
    frames = np.arange(len(points))
    before, after = np.maximum(frames - half, 0), np.minimum(frames + half, len(points) - 1)
    seconds = np.maximum(after - before, 1) / fps
    way = points[after] - points[before]
    return np.asarray(np.sqrt(np.einsum("fnd,fnd->fn", way, way)) / seconds[:, None])


def hysteresis(strict: BoolArray, loose: BoolArray) -> BoolArray:
    """The stretches of ``loose`` ``(F, N)`` along the first axis that hold at least one ``strict`` frame."""
    runs = Runs.of(loose)
    return runs.flags(runs.reduce(np.logical_or, runs.flat(strict)[runs.inside]))


def stretches(flags: BoolArray) -> list[tuple[int, int]]:
    """Start and stop (exclusive) of every run of true values in ``(F,)``."""
    runs = Runs.of(flags[:, None])
    return list(zip(runs.starts.tolist(), runs.stops.tolist(), strict=True))


def _without_flickers(flags: BoolArray, shortest: int) -> BoolArray:
    """Fill gaps, then drop contacts, of fewer than ``shortest`` frames; what touches an end of the motion stays."""
    flags = flags | _flickers(Runs.of(~flags), shortest)
    return flags & ~_flickers(Runs.of(flags), shortest)


def _flickers(runs: Runs, shortest: int) -> BoolArray:
    return runs.flags((runs.lengths < shortest) & ~runs.first & ~runs.last)
