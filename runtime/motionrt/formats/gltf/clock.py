"""The frames of an animation that has keys at any times: the rate that the keys stand for, and the times of frames."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from motionrt.motion.rotations import Array

USUAL_FPS = 30.0
"""Rate at which an animation is sampled whose keys follow no beat."""

_FPS_RANGE = (12.0, 480.0)
_SAME = 1e-5  # seconds: keys of different tracks that are this close are one
_ON_BEAT = 0.05  # share of a frame


def frame_times(keys: Iterable[Array], fps: float | None) -> tuple[Array, float, int]:
    """First key, rate and number of frames of tracks with keys at the given times (seconds).

    Args:
        keys: times of each track.
        fps: the rate wanted; ``None`` for that of the keys, or 30 where they follow no beat.

    Returns:
        Start in seconds, frames per second, frames. The last frame is not behind the last key.
    """
    times = np.unique(np.concatenate(list(keys)))
    times = times[np.concatenate([[True], np.diff(times) > _SAME])]
    rate = fps if fps is not None else _beat(times)
    return times[0], rate, int(np.floor((times[-1] - times[0]) * rate + 1e-3)) + 1


def _beat(times: Array) -> float:
    """The rate that puts all keys on frames, if it is a usual one."""
    if len(times) < 2:
        return USUAL_FPS
    shortest = float(np.diff(times).min())
    frames = round((times[-1] - times[0]) / shortest)
    rate = frames / float(times[-1] - times[0])
    places = (times - times[0]) * rate
    if not _FPS_RANGE[0] <= rate <= _FPS_RANGE[1] or np.abs(places - np.round(places)).max() > _ON_BEAT:
        return USUAL_FPS
    return float(round(rate)) if abs(round(rate) / rate - 1) < 1e-4 else rate
