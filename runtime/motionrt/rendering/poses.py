"""Which frames a picture shows, and what is written at each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from motionrt.rendering.look import Look
from motionrt.rendering.takes import Take

STRIP_POSES = 10
_APART, _MOST, _FEWEST = 0.9, 24, 5  # metres between poses on a way; how many there are
_PACE = 0.1  # metres per second that time counts, too

Ints = npt.NDArray[np.int64]


class Poses(NamedTuple):
    """Frames ``(P,)`` and a few words for each."""

    frames: Ints
    words: list[str]


def side_by_side(take: Take, look: Look) -> Poses:
    """The moments of the take, or poses at equal times."""
    motion = take.motion
    count = min(look.poses or STRIP_POSES, motion.frames)
    return _told(take) or _timed(take, np.linspace(0, motion.frames - 1, count).round().astype(np.int64))


def along_the_way(take: Take, look: Look) -> Poses:
    """The moments of the take, or poses evenly along its way and, where the character stays, in time."""
    motion = take.motion
    steps = np.linalg.norm(np.diff(motion.root[:, [0, 2]], axis=0), axis=1)
    count = look.poses or int(np.clip(round(float(steps.sum()) / _APART) + 1, _FEWEST, _MOST))
    along = np.append(0, np.cumsum(steps + _PACE / motion.fps))
    found = np.searchsorted(along, np.linspace(0, along[-1], min(count, motion.frames)))
    return _told(take) or _timed(take, np.minimum(found, motion.frames - 1))


def _told(take: Take) -> Poses | None:
    if not take.moments:
        return None
    seconds = np.array([moment for moment, _ in take.moments])
    frames = np.clip(np.round(seconds * take.motion.fps), 0, take.motion.frames - 1).astype(np.int64)
    return Poses(frames, [words for _, words in take.moments])


def _timed(take: Take, frames: Ints) -> Poses:
    return Poses(frames, [f"{frame / take.motion.fps:.1f} s" for frame in frames])
