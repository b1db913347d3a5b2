"""What the inverse kinematics gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from motionrt.locomotion.posing.body import Prior
from motionrt.locomotion.posing.search import Found
from motionrt.locomotion.posing.targets import Targets
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import axis_rotation, wrapped
from motionrt.motion.skeleton import FloatArray

FPS = 30.0
HOVER_CM = 5.0  # feet lower than this above the ground stand


@dataclass(frozen=True, eq=False)
class PoseSolution:
    """A pose that meets keypoints.

    Attributes:
        motion: one frame in world coordinates, at 30 fps.
        errors_cm: distance of every keypoint from its joint.
        heading: yaw of the pelvis, radians from +Z towards +X.
        latent: ``(32,)`` float32, where the prior has this pose.
        iterations: evaluations of the objective, over all starts.
    """

    motion: Motion
    errors_cm: Mapping[str, float]
    heading: float
    latent: FloatArray
    iterations: int

    @property
    def mean_error_cm(self) -> float:
        """Mean over the keypoints."""
        return float(np.mean(list(self.errors_cm.values())))

    @property
    def max_error_cm(self) -> float:
        """The keypoint that is missed most."""
        return max(self.errors_cm.values())


def solution_of(prior: Prior, found: Found, targets: Targets, iterations: int) -> PoseSolution:
    """The pose at which a search ended, and how well it meets its targets."""
    rotations = prior.decode(found.latent[None]).copy()
    rotations[:, 0] = axis_rotation("Y", np.float32(found.yaw)).astype(np.float32) @ rotations[:, 0]
    motion = Motion(rotations, found.root[None].astype(np.float32), FPS)
    heading = float(wrapped(found.yaw))
    return PoseSolution(motion, errors_cm(motion, targets), heading, found.latent.astype(np.float32), iterations)


def errors_cm(motion: Motion, targets: Targets) -> dict[str, float]:
    """Distance of every keypoint from its joint in frame 0."""
    reached = motion.positions()[0, list(targets.joints)]
    distances = 100.0 * np.linalg.norm(reached - targets.points, axis=1)
    return {name: float(distance) for name, distance in zip(targets.names, distances, strict=True)}


def hover_cm(motion: Motion, targets: Targets) -> float:
    """How far above the ground both feet hang that no keypoint holds up; 0 for feet that stand."""
    feet = [f"{side}_{part}" for side in ("left", "right") for part in ("foot", "ankle")]
    if targets.floor is None or targets.has(*feet):
        return 0.0
    toes = [SMPL24.index(name) for name in ("left_foot", "right_foot")]
    height = 100.0 * (float(motion.positions()[0, toes, 1].min()) - targets.floor)
    return height if height > HOVER_CM else 0.0
