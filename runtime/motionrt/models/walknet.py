"""WalkNet: the next frame of a walk towards a goal."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Sessions
from motionrt.motion.features import ccf219
from motionrt.motion.skeleton import FloatArray

WALKNET = "walknet"
HISTORY = 30  # K frames that it sees
WISH, WISHES = "wish", 8  # input of what is wished beside the goal, and its columns


class WalkModel:
    """Predicts one frame from the last 30; any number of characters in one call.

    Args:
        sessions: open models.
        variant: which file, e.g. ``fp32``; by default what the manifest says.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    @cached_property
    def wishes(self) -> bool:
        """Whether the file knows wishes: velocities, facings and speeds of arrival beside goals."""
        return any(known.name == WISH for known in self.sessions.session(WALKNET, self.variant).get_inputs())

    def __call__(self, frames: FloatArray, speed: FloatArray, wish: FloatArray | None = None) -> FloatArray:
        """The next frames ``(B, 219)`` float32, rotations not yet projected to SO(3).

        Args:
            frames: ``(B, 30, 219)`` ``ccf219`` at 30 fps in the goals' frames (the goal is the origin, heading +Z).
            speed: ``(B,)`` metres per second wanted.
            wish: ``(B, 8)`` rows as of :meth:`motionrt.locomotion.Wish.row`, in the goals' frames; by default none.

        Raises:
            InvalidInputError: another shape, or wishes that the file does not know.
        """
        if frames.shape[1:] != (HISTORY, ccf219.WIDTH) or speed.shape != frames.shape[:1]:
            expected = f"(B, {HISTORY}, {ccf219.WIDTH}) and (B,)"
            raise InvalidInputError(f"frames and speed must have the shapes {expected}: {frames.shape}, {speed.shape}")
        feeds = {"frames": np.ascontiguousarray(frames, np.float32), "speed": np.asarray(speed, np.float32)}
        if self.wishes:
            feeds[WISH] = _rows(wish, len(frames))
        elif wish is not None:
            raise InvalidInputError("this walknet knows goals alone; take the one that is shipped, which knows wishes")
        return self.sessions.run(WALKNET, ["next"], feeds, self.variant)[0]


def _rows(wish: FloatArray | None, count: int) -> FloatArray:
    if wish is None:
        return np.zeros((count, WISHES), np.float32)
    if wish.shape != (count, WISHES):
        raise InvalidInputError(f"wish must have the shape ({count}, {WISHES}), not {wish.shape}")
    return np.asarray(wish, np.float32)
