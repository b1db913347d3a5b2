"""TransNet: the hidden frames of a window between what is seen before and after them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Sessions
from motionrt.motion.features import ccf219
from motionrt.motion.skeleton import FloatArray

TRANSNET = "transnet"
WINDOW = 120  # M frames of a window
SEED = 60  # of them seen in front


class TransitionModel:
    """Fills the hidden frames of windows; any number of windows in one call.

    Args:
        sessions: open models.
        variant: which file, e.g. ``fp32``; by default what the manifest says.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    def __call__(self, frames: FloatArray, hidden: npt.NDArray[np.bool_]) -> FloatArray:
        """All frames ``(B, 120, 219)`` float32, hidden ones filled, rotations of those not yet projected to SO(3).

        Args:
            frames: ``(B, 120, 219)`` ``ccf219`` at 30 fps in the targets' frames (the pose of frame 119 stands at the
                origin, heading +Z); what hidden frames hold does not matter.
            hidden: ``(B, 120)`` bool: one gap in every window, of any length, whose first frame is frame 60; the last
                frame must be visible.

        Raises:
            InvalidInputError: another shape, another gap, or the end of a window is hidden.
        """
        if frames.shape[1:] != (WINDOW, ccf219.WIDTH) or hidden.shape != frames.shape[:2]:
            expected = f"(B, {WINDOW}, {ccf219.WIDTH}) and (B, {WINDOW})"
            raise InvalidInputError(
                f"frames and hidden must have the shapes {expected}, not {frames.shape} and {hidden.shape}"
            )
        if hidden[:, :SEED].any() or hidden[:, -1].any() or (hidden[:, SEED + 1 :] & ~hidden[:, SEED:-1]).any():
            raise InvalidInputError(
                f"a window has one gap, from frame {SEED} on, and its last frame must be visible: see hidden"
            )
        feeds = {"frames": np.ascontiguousarray(frames, np.float32), "hidden": np.asarray(hidden, bool)}
        return self.sessions.run(TRANSNET, ["motion"], feeds, self.variant)[0]
