"""WalkNet: the next frame of a walk towards a goal."""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Sessions
from motionrt.motion.features import ccf219
from motionrt.motion.skeleton import FloatArray

WALKNET = "walknet"
HISTORY = 30  # K frames that it sees


class WalkModel:
    """Predicts one frame from the last 30; any number of characters in one call.

    Args:
        sessions: open models.
        variant: which file, e.g. ``fp32``; by default what the manifest says.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    def __call__(self, frames: FloatArray, speed: FloatArray) -> FloatArray:
        """The next frames ``(B, 219)`` float32, rotations not yet projected to SO(3).

        Args:
            frames: ``(B, 30, 219)`` ``ccf219`` at 30 fps in the goals' frames (the goal is the origin, heading +Z).
            speed: ``(B,)`` metres per second wanted.

        Raises:
            InvalidInputError: another shape.
        """
        if frames.shape[1:] != (HISTORY, ccf219.WIDTH) or speed.shape != frames.shape[:1]:
            expected = f"(B, {HISTORY}, {ccf219.WIDTH}) and (B,)"
            raise InvalidInputError(f"frames and speed must have the shapes {expected}: {frames.shape}, {speed.shape}")
        feeds = {"frames": np.ascontiguousarray(frames, np.float32), "speed": np.asarray(speed, np.float32)}
        return self.sessions.run(WALKNET, ["next"], feeds, self.variant)[0]
