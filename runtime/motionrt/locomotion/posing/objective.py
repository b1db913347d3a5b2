"""What a pose is judged by: eq. 1 of the paper and what keeps a pose on the ground where the keypoints leave it open.

    E(z, t, yaw) = sum_k |p_k(z, t, yaw) - target_k|^2 / reach^2 + |z|^2 + ground + balance + effort + heading + inside

The pelvis' tilt comes from the latent, so of the root's orientation only the yaw is left to search for. Every term is a
row of residuals, evaluated for a batch of poses at once: a Jacobian by finite differences costs one decoding of 1 + 32
latents.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.posing.targets import Targets
from motionrt.metrics.penetration import Surfaces, ball_depths
from motionrt.motion import SMPL24
from motionrt.motion.rotations import wrapped

Rows = npt.NDArray[np.float64]

# Clearance of a joint's centre above the ground, metres: what a foot, a shin or a hand has under it.
_CLEARANCE = np.full(len(SMPL24), 0.05)
for _name, _height in (("foot", 0.0), ("ankle", 0.05), ("hand", 0.02), ("wrist", 0.02)):
    for _side in ("left", "right"):
        _CLEARANCE[SMPL24.index(f"{_side}_{_name}")] = _height
_CLEARANCE[SMPL24.index("pelvis")] = 0.09

# Fraction of the body's mass near a joint.
_MASS = {"pelvis": 0.14, "spine2": 0.16, "spine3": 0.16, "head": 0.08} | {
    f"{side}_{name}": mass
    for side in ("left", "right")
    for name, mass in (
        ("hip", 0.06),
        ("knee", 0.09),
        ("ankle", 0.03),
        ("shoulder", 0.02),
        ("elbow", 0.02),
        ("hand", 0.01),
    )
}
_MASSES = np.array([_MASS.get(name, 0.0) for name in SMPL24.names])

_LEG = float(np.linalg.norm(SMPL24.offsets[[SMPL24.index("left_knee"), SMPL24.index("left_ankle")]].sum(axis=0)))

FOOT_PULLS = {"foot": 0.0, "ankle": 0.068}  # height of the joint of a foot that stands flat
FARTHEST = 8.0  # length of a latent; of a million draws from N(0, 1) in 32 dimensions about fifty are longer
AT_REST = 0.45  # metres that a wrist hangs below its shoulder
NEAR_GROUND = 0.15  # a foot whose keypoint is higher than this does not stand


@dataclass(frozen=True)
class Weights:
    """How far a pose may be off before it counts as much as a latent one deviation from its mean; metres, radians.

    ``prior`` and ``bound`` are factors: of the latent, and of what it is longer than ``FARTHEST``.
    """

    reach: float = 0.01
    ground: float = 0.01
    stand: float = 0.04
    balance: float = 0.10
    heading: float = 0.15
    facing: float = 0.80
    rest: float = 0.12
    straight: float = 0.15
    inside: float = 0.01
    prior: float = 1.0
    bound: float = 10.0


class Objective:
    """Residuals of a batch of poses against targets."""

    def __init__(self, targets: Targets, weights: Weights | None = None, surfaces: Surfaces | None = None) -> None:
        self.targets, self.weights, self.surfaces = targets, weights or Weights(), surfaces
        self._joints, self._suggested = list(targets.joints), targets.suggested
        self._feet = _standing_joints(targets)
        self._stands = not targets.has("pelvis", "left_hip", "right_hip") and targets.floor is not None
        self._hands, self._shoulders = _resting_arms(targets)
        self._hips = [SMPL24.index(name) for name in ("left_hip", "right_hip")]
        self._ankles = [SMPL24.index(name) for name in ("left_ankle", "right_ankle")]

    def rows(self, latents: Rows, positions: Rows, yaw: Rows) -> Rows:
        """Residuals ``(B, M)`` of latents ``(B, 32)``, world positions ``(B, 24, 3)`` and pelvis yaws ``(B,)``."""
        w = self.weights
        parts = [
            ((positions[:, self._joints] - self.targets.points) / w.reach).reshape(len(positions), -1),
            latents * w.prior,
            np.maximum(np.linalg.norm(latents, axis=1, keepdims=True) - FARTHEST, 0.0) * w.bound,
        ]
        if self.targets.floor is not None:
            parts += self._ground(positions, self.targets.floor)
        if self._stands:
            parts += [self._unbalance(positions) / w.balance, self._bend(positions) / w.straight]
        if self._hands:
            parts.append(self._effort(positions) / w.rest)
        if self.surfaces is not None:
            parts.append(ball_depths(positions, self.surfaces) / w.inside)
        if self.targets.heading is not None:
            parts.append(wrapped(yaw - self.targets.heading)[:, None] / w.heading)
        elif self._suggested is not None:
            parts.append(2.0 * np.sin(0.5 * wrapped(yaw - self._suggested))[:, None] / w.facing)
        return np.concatenate(parts, axis=1)

    def _ground(self, positions: Rows, floor: float) -> list[Rows]:
        heights = positions[:, :, 1] - floor
        below = np.minimum(heights - _CLEARANCE, 0.0) / self.weights.ground
        feet, flat = [joint for joint, _ in self._feet], [height for _, height in self._feet]
        return [below, (heights[:, feet] - flat) / self.weights.stand]

    def _unbalance(self, positions: Rows) -> Rows:
        """From the middle of the ankles to the centre of mass, in the ground plane ``(B, 2)``."""
        centre = np.einsum("j,bjd->bd", _MASSES / _MASSES.sum(), positions)
        support = positions[:, self._ankles].mean(axis=1)
        return np.asarray((centre - support)[:, [0, 2]])

    def _bend(self, positions: Rows) -> Rows:
        """How much shorter than straight ``(B, 2)`` the legs are."""
        length = np.linalg.norm(positions[:, self._hips] - positions[:, self._ankles], axis=-1)
        return np.asarray(_LEG - length)

    def _effort(self, positions: Rows) -> Rows:
        """How much higher than at rest ``(B, A)`` the wrists of the arms with nothing to do are."""
        drop = positions[:, self._shoulders, 1] - positions[:, self._hands, 1]
        return np.maximum(AT_REST - drop, 0.0)


def _resting_arms(targets: Targets) -> tuple[list[int], list[int]]:
    """Wrists and shoulders of the arms that hold no keypoint."""
    free = [
        side
        for side in ("left", "right")
        if not targets.has(*(f"{side}_{part}" for part in ("hand", "wrist", "elbow")))
    ]
    return [SMPL24.index(f"{side}_wrist") for side in free], [SMPL24.index(f"{side}_shoulder") for side in free]


def _standing_joints(targets: Targets) -> list[tuple[int, float]]:
    """(joint, height) that a foot is drawn to: of every foot that no keypoint holds above the ground."""
    joints = []
    for side in ("left", "right"):
        names = {f"{side}_{part}": height for part, height in FOOT_PULLS.items()}
        held = [targets.points[targets.names.index(name), 1] for name in names if name in targets.names]
        if targets.floor is None or any(height > targets.floor + NEAR_GROUND for height in held):
            continue
        joints += [(SMPL24.index(name), height) for name, height in names.items() if name not in targets.names]
    return joints
