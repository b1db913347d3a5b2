"""What every measure starts from: joints at 30 fps above their floor, heading, sizes and small filters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.batches import by_batches
from motionrt.motion.skeleton import SMPL24

Array = npt.NDArray[np.float64]
FPS = 30.0
JOINT = {name: index for index, name in enumerate(SMPL24.names)}
SIDES = ("left", "right")
HELD_S = 0.1  # seconds that a height or lean must be held to count
_ON_FLOOR = 5.0  # percentile of the lowest joint's height that is the floor
_PELVIS_OVER_LEG = 1.172  # standing height of the pelvis over the length of a leg, from the canonical skeleton


@dataclass(frozen=True, eq=False)
class Body:
    """A clip's joints at 30 fps, the floor at height 0.

    Attributes:
        joints: ``(F, 24, 3)`` metres, Y up.
    """

    joints: Array

    @classmethod
    def of(cls, positions: npt.ArrayLike, fps: float) -> Body:
        """From joint positions ``(F, 24, 3)`` at any frame rate.

        Raises:
            InvalidInputError: another shape, numbers that are not finite, or a frame rate that is not positive.
        """
        joints = np.asarray(positions)
        if joints.ndim != 3 or joints.shape[1:] != (len(SMPL24), 3) or not len(joints):
            raise InvalidInputError(f"positions must have the shape (frames >= 1, 24, 3), not {joints.shape}")
        joints = by_batches(lambda part: part.astype(np.float64), joints)
        if not by_batches(lambda part: np.isfinite(part).all(axis=(1, 2)), joints).all():
            raise InvalidInputError("positions hold a number that is not finite")
        if not (np.isfinite(fps) and fps > 0):
            raise InvalidInputError(f"fps must be a positive number, not {fps}")
        joints = _at_30(joints, float(fps))
        lowest = by_batches(lambda part: part[..., 1].min(axis=1), joints)
        floor = [0.0, np.percentile(lowest, _ON_FLOOR), 0.0]
        return cls(by_batches(lambda part: part - floor, joints))

    def __getitem__(self, joint: str) -> Array:
        """Path of a joint ``(F, 3)``."""
        return self.joints[:, JOINT[joint]]

    @property
    def seconds(self) -> float:
        """From the first frame to the last, at least one frame."""
        return max(len(self.joints) - 1, 1) / FPS

    @cached_property
    def standing(self) -> float:
        """Height of the pelvis when standing upright, metres, from the lengths of the legs."""
        leg = [
            np.linalg.norm(self[f"{s}_{a}"] - self[f"{s}_{b}"], axis=1).mean()
            for s in SIDES
            for a, b in (("hip", "knee"), ("knee", "ankle"))
        ]
        return max(float(sum(leg)) / 2, 1e-3) * _PELVIS_OVER_LEG

    @cached_property
    def low(self) -> Array:
        """``(F,)`` height of the pelvis, 1 when standing upright."""
        return np.asarray(self["pelvis"][:, 1] / self.standing)

    @cached_property
    def yaw(self) -> Array:
        """``(F,)`` heading, radians, unwrapped: 0 faces +Z, left is positive; bridged where it cannot be told."""
        across = self["left_hip"] - self["right_hip"] + 0.5 * (self["left_shoulder"] - self["right_shoulder"])
        level = np.hypot(across[:, 0], across[:, 2]) > 0.6 * np.linalg.norm(across, axis=1)
        told = np.flatnonzero(level & (self["neck"][:, 1] > self["pelvis"][:, 1] - 0.1))
        told = told if len(told) else np.arange(len(across))
        angles = np.unwrap(np.arctan2(-across[told, 2], across[told, 0]))
        return smooth(np.interp(np.arange(len(across)), told, angles), 0.17)

    @cached_property
    def facing(self) -> Array:
        """``(F, 3)`` unit vector on the ground that the body faces."""
        return np.stack([np.sin(self.yaw), np.zeros_like(self.yaw), np.cos(self.yaw)], axis=1)

    @cached_property
    def own(self) -> Array:
        """``(F, 24, 3)`` joints from the pelvis, in axes that turn with the body: left, up, forward; metres."""
        return by_batches(_own, self.joints, self.yaw)

    @cached_property
    def ground(self) -> Array:
        """``(F, 2)`` smoothed path of the pelvis over the ground (x, z), metres."""
        return smooth(self["pelvis"][:, [0, 2]], 0.37)

    def moving(self, pairs: Sequence[tuple[str, str]]) -> Array:
        """``(F, K)`` speeds of joints about other ones, in the body's own axes, m/s."""
        of, about = ([JOINT[pair[k]] for pair in pairs] for k in (0, 1))
        return speed(by_batches(lambda own: own[:, of] - own[:, about], self.own))


def _own(joints: Array, yaw: Array) -> Array:
    away = joints - joints[:, :1]
    c, s = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    x, z = away[..., 0], away[..., 2]
    return np.stack([x * c - z * s, away[..., 1], x * s + z * c], axis=-1)


def speed(path: Array) -> Array:
    """``(F, ...)`` speed of points ``(F, ..., D)``, m/s; of one frame 0."""
    if len(path) < 2:
        return np.zeros(path.shape[:-1])
    steps = by_batches(lambda here, there: np.sqrt(np.square(there - here).sum(axis=-1)) * FPS, path[:-1], path[1:])
    return np.concatenate([steps, steps[-1:]])


def smooth(values: Array, seconds: float) -> Array:
    """Mean over a window, without drawing the ends in: lines stay lines, ``(F, ...)``."""
    half = min(round(seconds * FPS) // 2, len(values) - 1)
    if half < 1:
        return values
    before = 2 * values[:1] - values[half:0:-1]
    after = 2 * values[-1:] - values[-2 : -half - 2 : -1]
    total = np.cumsum(np.concatenate([np.zeros_like(values[:1]), before, values, after]), axis=0)
    return np.asarray((total[2 * half + 1 :] - total[: -2 * half - 1]) / (2 * half + 1))


def held(values: Array) -> float:
    """The highest value that is held for a tenth of a second in all."""
    k = min(max(round(HELD_S * FPS), 1), len(values))
    return float(np.partition(values, -k)[-k])


def running_low(values: Array, seconds: float) -> Array:
    """``(F,)`` lowest value within a window about each frame."""
    half = max(round(seconds * FPS) // 2, 1)
    low, size, width = np.pad(values, half, mode="edge"), 1, 2 * half + 1
    while size < width:  # the lowest of two windows that overlap
        step = min(size, width - size)
        low, size = np.minimum(low[:-step], low[step:]), size + step
    return np.asarray(low)


def cycles(values: Array, least: float) -> int:
    """How often values rise and fall again by at least ``least``."""
    count, low, high, rising = 0, values[0], values[0], False
    for value in values.tolist():
        if rising:
            high = max(high, value)
            if value < high - least:
                count, rising, low = count + 1, False, value
        else:
            low = min(low, value)
            if value > low + least:
                rising, high = True, value
    return count


def _at_30(joints: Array, fps: float) -> Array:
    if abs(fps - FPS) < 1e-6 or len(joints) == 1:
        return joints
    at = np.arange(int((len(joints) - 1) / fps * FPS + 1e-6) + 1) * (fps / FPS)
    first = np.minimum(at.astype(np.intp), len(joints) - 2)
    part = (at - first)[:, None, None]
    return np.asarray(joints[first] * (1 - part) + joints[first + 1] * part)
