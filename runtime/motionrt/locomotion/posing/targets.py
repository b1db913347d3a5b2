"""Keypoints as they are asked for: checked names and numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import check_kind, checked_array, real
from motionrt.untrusted.words import shown

LEAST_STANCE = 0.05  # metres; feet nearer than this say nothing of where the body faces


@dataclass(frozen=True, eq=False)
class Targets:
    """``K`` joints of smpl24 and where they shall be.

    Attributes:
        names: joint names.
        joints: ``(K,)`` their indices.
        points: ``(K, 3)`` float64, metres, world.
        heading: yaw that the pelvis shall have, or None.
        floor: height of the ground, or None where there is none.
    """

    names: tuple[str, ...]
    joints: tuple[int, ...]
    points: npt.NDArray[np.float64]
    heading: float | None
    floor: float | None

    def has(self, *names: str) -> bool:
        """Whether any of these joints is a keypoint."""
        return any(name in self.names for name in names)

    @property
    def suggested(self) -> float | None:
        """The yaw of a body whose left foot is to the left of its right one; None without both feet as keypoints."""
        for part in ("foot", "ankle"):
            if f"left_{part}" in self.names and f"right_{part}" in self.names:
                left, right = (self.points[self.names.index(f"{side}_{part}")] for side in ("left", "right"))
                x, _, z = left - right
                return float(np.arctan2(-z, x)) if np.hypot(x, z) > LEAST_STANCE else None
        return None

    @property
    def middle(self) -> npt.NDArray[np.float64]:
        """The ground point ``(3,)`` (y = 0) in the middle of the keypoints."""
        return np.asarray(self.points.mean(axis=0) * [1.0, 0.0, 1.0])

    def moved(self, offset: npt.NDArray[np.float64]) -> Targets:
        """The same keypoints, ``offset`` ``(3,)`` metres further on."""
        return replace(self, points=self.points + offset)

    def mapping(self) -> dict[str, FloatArray]:
        """{joint name: (3,) metres}."""
        return {name: point.astype(np.float32) for name, point in zip(self.names, self.points, strict=True)}


def targets_of(
    keypoints: Mapping[str, Sequence[float] | npt.ArrayLike], heading: float | None, floor: float | None
) -> Targets:
    """Check what a caller asks for.

    Raises:
        InvalidInputError: no keypoint, an unknown joint, or anything that is not three finite numbers.
    """
    check_kind(keypoints, Mapping, "keypoints", "like {'left_hand': (0.3, 1.2, 0.4)}")
    if not keypoints:
        raise InvalidInputError("give at least one keypoint, as in {'left_hand': (0.3, 1.2, 0.4)}")
    joints = tuple(SMPL24.index(name) for name in keypoints)
    points = np.stack([_point(name, value) for name, value in keypoints.items()])
    for name, number in (("heading", heading), ("floor", floor)):
        if number is not None and not np.isfinite(real(number)):
            raise InvalidInputError(f"{name} must be a finite number or None, not {shown(number)}")
    return Targets(tuple(keypoints), joints, points, heading, floor)


def _point(name: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    point = checked_array(value, f"keypoint '{name}'", "three finite numbers (x, y, z) in metres")
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InvalidInputError(
            f"keypoint '{name}' must be three finite numbers (x, y, z) in metres, not {shown(value)}"
        )
    return point
