"""The goal-centric canonical frame: planar translation and yaw of a goal removed  [Continual 3.4 and 3.5, eq. 2-5].

``C(X; R, t)``: the goal becomes the origin and its heading +Z. Heights stay. Only the pelvis turns: all other
rotations are local to their parents.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.limits import check_place
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.rotations import Array, axis_rotation
from motionrt.motion.transforms import moved, turned
from motionrt.untrusted.arguments import check_kind

PELVIS = slice(0, 9)


@dataclass(frozen=True)
class Goal:
    """Where to be, and facing where.

    Attributes:
        x, z: metres on the ground plane.
        heading: yaw in radians from +Z towards +X.

    Raises:
        InvalidInputError: a number that is not finite.
    """

    x: float
    z: float
    heading: float = 0.0

    def __post_init__(self) -> None:
        check_place("a goal (x, z, heading)", (self.x, self.z), self.heading)

    def row(self) -> tuple[float, float, float]:
        """(x, z, heading), as the batched functions take it."""
        return self.x, self.z, self.heading


def canonicalise(motion: Motion, goal: Goal) -> Motion:
    """``motion`` seen from ``goal`` (eq. 2 and 3)."""
    _check(motion, goal)
    return turned(moved(motion, np.array([-goal.x, 0, -goal.z])), -goal.heading)


def uncanonicalise(motion: Motion, goal: Goal) -> Motion:
    """Inverse of :func:`canonicalise` (eq. 5; eq. 4 gives t and R of a waypoint and its tangent)."""
    _check(motion, goal)
    return moved(turned(motion, goal.heading), np.array([goal.x, 0, goal.z]))


def _check(motion: Motion, goal: Goal) -> None:
    check_kind(motion, Motion, "motion", "a Motion")
    check_kind(goal, Goal, "goal", "a Goal")


def frames_to_goal(frames: Array, goals: Array) -> Array:
    """:func:`canonicalise` of ``ccf219`` frames ``(B, F, 219)`` to goals ``(B, 3)`` (x, z, heading)."""
    goals = np.asarray(goals, dtype=np.float64)
    return _turned(frames, frames[..., ccf219.ROOT] - _place(goals), axis_rotation("Y", -goals[:, 2]))


def frames_from_goal(frames: Array, goals: Array) -> Array:
    """Inverse of :func:`frames_to_goal`."""
    goals = np.asarray(goals, dtype=np.float64)
    out = _turned(frames, frames[..., ccf219.ROOT], axis_rotation("Y", goals[:, 2]))
    out[..., ccf219.ROOT] += _place(goals)
    return out


def _turned(frames: Array, root: Array, turn: Array) -> Array:
    """Pelvis and ``root`` turned by ``(B, 3, 3)``."""
    out = np.array(frames, dtype=np.float64)
    pelvis = frames[..., PELVIS].reshape(*frames.shape[:-1], 3, 3)
    out[..., PELVIS] = (turn[:, None] @ pelvis).reshape(*frames.shape[:-1], 9)
    out[..., ccf219.ROOT] = root @ np.swapaxes(turn, -1, -2)
    return out


def _place(goals: Array) -> Array:
    """(B, 1, 3) translation of each goal on the ground plane."""
    return np.stack([goals[:, 0], np.zeros(len(goals)), goals[:, 1]], axis=-1)[:, None]
