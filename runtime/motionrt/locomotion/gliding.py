"""A walk whose feet begin to glide goes on as it walked before: networks fall into gliding, and stay there."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.crowd import FPS, to_motion
from motionrt.locomotion.goal_frame import frames_from_goal, frames_to_goal
from motionrt.metrics.locomotion import foot_skates
from motionrt.models.walknet import HISTORY
from motionrt.motion.features import ccf219
from motionrt.motion.rotations import Array, project_to_so3

GLIDES, WALKS = 3.0, 2.0  # cm/frame of foot skate, unlocked, from which feet glide, and up to which a gait is kept
SEEN = 20  # frames that are looked at
EVERY = 10  # frames from one look to the next
KEPT_FROM, KEPT = 30, 90  # frames after which a gait is remembered, and how many
FADES_S = 0.3  # seconds in which the pose from before becomes the new one
_BEFORE = 3  # frames before the last that show where limbs are going

Frames = npt.NDArray[np.float64]


class Gait:
    """What one walker does, and how it walked when it walked well."""

    def __init__(self) -> None:
        self.frames: list[Frames] = []  # as they are shown
        self._good: Frames | None = None
        self._turned: Frames | None = None  # rotations (24, 3, 3) from the new pose to the one that was shown
        self._raised = 0.0
        self._left = 0

    def show(self, frame: Frames) -> None:
        """Take a new frame ``(219,)``; what an exchange of gaits changed is faded out."""
        if self._turned is not None and self._left > 0:
            share = _eased(self._left / round(FADES_S * FPS))
            frame = frame.copy()
            rotations = frame[ccf219.ROTATIONS].reshape(-1, 3, 3)
            between = np.eye(3) + share * (self._turned - np.eye(3))
            frame[ccf219.ROTATIONS] = project_to_so3(between @ rotations).ravel()
            frame[217] += share * self._raised
            self._left -= 1
        self.frames.append(frame)

    def revived(self, history: Frames) -> Frames:
        """The history ``(30, 219)`` to go on from: as it is, or an earlier one put where the walker is."""
        count = len(self.frames)
        if count % EVERY or count < KEPT_FROM:
            return history
        glides = float(foot_skates(to_motion(history[-SEEN:]).positions()).mean())
        if self._good is None and count >= KEPT_FROM + KEPT and glides < WALKS:
            self._good = np.stack(self.frames[-KEPT:])
        if glides < GLIDES or self._good is None or self._left > 0:
            return history
        now = history[-1]
        ends = np.arange(HISTORY, len(self._good) + 1)
        looks = _seen_from_itself(history[[-1 - _BEFORE, -1]])
        known = np.stack([_seen_from_itself(self._good[[end - 1 - _BEFORE, end - 1]]) for end in ends])
        end = int(ends[np.square(known - looks).sum(axis=(1, 2)).argmin()])
        found = self._good[end - HISTORY : end]
        put = frames_from_goal(frames_to_goal(found[None], _place(found[-1])), _place(now))[0]
        shown, new = (row[ccf219.ROTATIONS].reshape(-1, 3, 3) for row in (self.frames[-1], put[-1]))
        self._turned, self._raised = shown @ np.swapaxes(new, -1, -2), float(self.frames[-1][217] - put[-1, 217])
        self._left = round(FADES_S * FPS)
        return np.asarray(put)


def _eased(share: float) -> float:
    return share * share * (3.0 - 2.0 * share)


def _place(frame: Frames) -> Frames:
    """``(1, 3)``: x, z and heading of a frame."""
    return np.array([[frame[216], frame[218], np.arctan2(frame[2], frame[8])]])


def _seen_from_itself(frames: Frames) -> Array:
    """Rotations of frames ``(F, 219)`` in the frame of the last one's heading."""
    return np.asarray(frames_to_goal(frames[None], _place(frames[-1]))[0][:, ccf219.ROTATIONS])
