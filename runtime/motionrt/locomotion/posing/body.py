"""A pose in the world: what the prior decodes, turned by its yaw and put at its place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from motionrt.motion import SMPL24
from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.skeleton import FloatArray

Rows = npt.NDArray[np.float64]


class Prior(Protocol):
    """What the inverse kinematics needs of :class:`motionrt.models.pose_prior.PosePrior`."""

    latent: int

    def decode(self, latents: npt.ArrayLike) -> FloatArray:
        """Rotations ``(B, 24, 3, 3)`` of latents ``(B, latent)``."""

    @property
    def starts(self) -> tuple[FloatArray, FloatArray]:
        """Latents ``(S, latent)`` and joints ``(S, 24, 3)`` about the pelvis that a search may begin at."""


@dataclass(frozen=True, eq=False)
class Bodies:
    """``B`` poses with the pelvis at the origin and without yaw; float64."""

    latents: Rows  # (B, latent)
    positions: Rows  # (B, 24, 3)

    def placed(self, root: Rows, yaw: Rows) -> Rows:
        """World positions ``(B, 24, 3)`` for pelvises at ``root`` ``(B, 3)`` turned by ``yaw`` ``(B,)``."""
        return turned(self.positions, yaw) + root[:, None]


def positions(rotations: FloatArray) -> Rows:
    """Joints ``(B, 24, 3)`` of decoded rotations ``(B, 24, 3, 3)``, the pelvis at the origin; float64."""
    origin = np.zeros((len(rotations), 3), rotations.dtype)
    return fk(rotations, origin, SMPL24.offsets, SMPL24.parents)[0].astype(np.float64)


def turned(points: Rows, yaw: Rows) -> Rows:
    """Points ``(B, N, 3)`` turned about Y by ``yaw`` ``(B,)``."""
    return np.asarray(points @ np.swapaxes(axis_rotation("Y", yaw), -1, -2))
