"""Walking at stride 1: many characters, a frame at a time, each towards its own goal  [Continual 3.5].

Every step looks at the last 30 frames from the goal, predicts, and keeps one frame. A game's loop calls
:meth:`Crowd.step`; goals may change between any two frames.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, WalkError
from motionrt.locomotion.goal_frame import frames_from_goal, frames_to_goal
from motionrt.locomotion.wishes import COLUMNS, wishes_to_goal
from motionrt.models.walknet import HISTORY
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.rotations import Array, project_to_so3
from motionrt.motion.skeleton import FloatArray

FPS = ccf219.FPS
SPEED = 1.2  # m/s that a character walks if nothing else is wanted

NextFrame = Callable[..., FloatArray]
"""frames (B, 30, 219) in the goals' frames, speeds (B,) m/s -> next frames (B, 219) in the same frames.

A third argument, where somebody has wishes: (B, 8), see :data:`motionrt.locomotion.wishes.COLUMNS`, in these frames."""


def takes_wishes(model: NextFrame) -> bool:
    """Whether a model knows wishes; one that does says so by an attribute ``wishes``."""
    return bool(getattr(model, "wishes", False))


class Crowd:
    """``B`` characters that walk; one call of the model moves all of them by one frame.

    Args:
        model: predicts the next frame of each.
        history: ``(B, 30, 219)`` ``ccf219`` at 30 fps, the last second of each character in the world.

    Raises:
        InvalidInputError: a history of another shape, or numbers that are not finite.
    """

    def __init__(self, model: NextFrame, history: Array) -> None:
        self._model = model
        self.history = np.array(history, dtype=np.float64)
        if self.history.ndim != 3 or self.history.shape[1:] != (HISTORY, ccf219.WIDTH):
            raise InvalidInputError(
                f"history must have the shape (B, {HISTORY}, {ccf219.WIDTH}), not {self.history.shape}"
            )
        if not np.isfinite(self.history).all():
            raise InvalidInputError("history holds a number that is not finite")

    def __len__(self) -> int:
        return len(self.history)

    def keep(self, stays: npt.NDArray[np.bool_]) -> None:
        """Go on with some of the characters only: ``(B,)`` bool."""
        self.history = self.history[stays]

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """``(B, 2)`` where each pelvis is over the ground now: x, z in metres."""
        return self.history[:, -1, [216, 218]]

    def step(self, goals: Array, speeds: float | Array = SPEED, wishes: Array | None = None) -> npt.NDArray[np.float64]:
        """Move every character by one frame (1/30 s).

        Args:
            goals: ``(B, 3)`` x, z and heading to arrive with.
            speeds: metres per second wanted, one for all or ``(B,)``.
            wishes: ``(B, 8)`` rows of :meth:`motionrt.locomotion.Wish.row`, or none.

        Returns:
            ``(B, 219)`` the new frames in the world.

        Raises:
            InvalidInputError: goals of another shape, or not finite.
            WalkError: the model predicts numbers that are not finite.
        """
        goals = np.asarray(goals, dtype=np.float64)
        if goals.shape != (len(self), 3) or not np.isfinite(goals).all():
            raise InvalidInputError(f"goals must be {len(self)} finite rows of x, z, heading; got {goals.shape}")
        wanted = np.broadcast_to(np.asarray(speeds, dtype=np.float32), (len(self),))
        seen = frames_to_goal(self.history, goals).astype(np.float32)
        told = () if wishes is None else (wishes_to_goal(_checked(wishes, len(self)), goals),)
        predicted = self._model(seen, wanted, *told)
        if not np.isfinite(predicted).all():
            raise WalkError("the model predicts numbers that are not finite: check the history, and the model's files")
        new = frames_from_goal(_on_so3(predicted)[:, None], goals)
        self.history = np.concatenate([self.history[:, 1:], new], axis=1)
        return np.asarray(new[:, 0])


def history_of(motion: Motion) -> FloatArray:
    """The last second of a motion as ``(30, 219)``; a shorter one is preceded by its first frame.

    Raises:
        InvalidInputError: another frame rate than 30 fps.
    """
    frames = ccf219.encode(at_30_fps(motion)[-HISTORY:])
    return np.pad(frames, ((HISTORY - len(frames), 0), (0, 0)), mode="edge")


def at_30_fps(motion: Motion) -> Motion:
    """The same motion; InvalidInputError for another frame rate than 30 fps."""
    if abs(motion.fps - FPS) > 1e-6:
        raise InvalidInputError(f"walking goes on at {FPS:g} fps, not {motion.fps:g}: call .resample({FPS:g}) first")
    return motion


def to_motion(frames: Array) -> Motion:
    """``(F, 219)`` frames whose rotations are proper -> Motion at 30 fps."""
    return Motion(frames[:, ccf219.ROTATIONS].reshape(len(frames), -1, 3, 3), frames[:, ccf219.ROOT], FPS)


def _checked(wishes: Array, count: int) -> npt.NDArray[np.float64]:
    rows = np.asarray(wishes, dtype=np.float64)
    if rows.shape != (count, COLUMNS) or not np.isfinite(rows).all():
        raise InvalidInputError(f"wishes must be {count} finite rows of {COLUMNS} numbers; got {rows.shape}")
    return rows


def _on_so3(frames: FloatArray) -> FloatArray:
    """(B, 219) with every matrix replaced by the nearest rotation."""
    out = np.array(frames, dtype=np.float32)
    out[:, ccf219.ROTATIONS] = project_to_so3(out[:, ccf219.ROTATIONS].reshape(-1, 3, 3)).reshape(len(frames), -1)
    return out
