"""The phase of a gait, and one gait read in the phase of another, so that arms swing with legs that are not theirs."""

from __future__ import annotations

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.transforms import facing

LEAST_SWING = 0.1  # metres from the middle that a foot or a hand must swing to be a gait
_LEGS, _ARMS = ("left_ankle", "right_ankle"), ("right_wrist", "left_wrist")  # arms swing against the legs
_ENTER = 0.25  # share of the swing that must be crossed on both sides: smaller wiggles are no steps


def gait_phase(motion: Motion) -> Array | None:
    """``(F,)`` cycles (two steps each) since some start, growing; a whole number when the left foot passes the right.

    Between two passings the phase is linear in time, half a cycle each; before the first and after the last it goes
    on at the same pace. A motion whose feet do not step, but whose arms swing, has the phase of its arms.
    ``None``: neither feet nor arms make a whole cycle.
    """
    for pair in (_LEGS, _ARMS):
        phase = _phase(_swing(motion, pair))
        if phase is not None:
            return phase
    return None


def in_phase(gait: Array, other: Array) -> Array:
    """Where another motion must be read to walk in step: its frame for every frame of ``gait``.

    Args:
        gait: ``(F,)`` phase to follow.
        other: ``(G,)`` phase of the other motion, at least one cycle of it.

    Returns:
        ``(N,)`` times in frames of the other motion, growing, the first within its first cycle; N <= F, as far as
        the other motion lasts.
    """
    aim = gait + np.ceil(other[0] - gait[0])
    aim = aim[aim <= other[-1] + 1e-9]
    return np.asarray(np.interp(aim, other, np.arange(len(other))))


def _swing(motion: Motion, pair: tuple[str, str]) -> Array:
    """``(F,)`` metres that the first of two joints is ahead of the second."""
    first, second = (motion.positions()[:, motion.skeleton.index(name)] for name in pair)
    return np.asarray(((first - second) * facing(motion)).sum(axis=-1))


def _phase(swing: Array) -> Array | None:
    low, high = np.percentile(swing, [5, 95])
    swing, reach = swing - (low + high) / 2, (high - low) / 2
    if reach < LEAST_SWING:
        return None
    times, upwards = _crossings(swing, _ENTER * reach)
    if len(times) < 3:
        return None
    halves = np.arange(len(times)) + (0 if upwards else 1)
    frames = np.arange(len(swing))
    phase = np.interp(frames, times, halves)
    early, late = frames < times[0], frames > times[-1]
    phase[early] = halves[0] + (frames[early] - times[0]) * 2 / (times[2] - times[0])
    phase[late] = halves[-1] + (frames[late] - times[-1]) * 2 / (times[-1] - times[-3])
    return np.asarray(phase / 2)


def _crossings(swing: Array, enter: float) -> tuple[Array, bool]:
    """Times in frames at which the sign changes for good, and whether the first change is upwards."""
    sides = np.flatnonzero(np.abs(swing) > enter)
    signs = np.sign(swing[sides])
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    times = [_zero(swing, int(sides[i]), int(sides[i + 1])) for i in changes]
    return np.array(times), bool(len(changes) and signs[changes[0]] < 0)


def _zero(swing: Array, start: int, stop: int) -> float:
    """The last time between two frames at which ``swing`` crosses zero, linear between frames."""
    part = swing[start : stop + 1]
    before = int(np.flatnonzero(np.sign(part) != np.sign(part[-1]))[-1])
    return start + before + float(part[before] / (part[before] - part[before + 1]))
