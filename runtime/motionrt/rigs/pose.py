"""Poses of a rig seen through its roles: body axes, and whether a still pose is a known standing pose."""

from __future__ import annotations

import numpy as np

from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import Array, normalise
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.rigs.roles import RigRoles

_SNAP_UP, _SNAP_YAW = float(np.cos(np.deg2rad(20.0))), float(np.cos(np.deg2rad(4.0)))
_SIDES = ("left", "right")


class RigPose:
    """Global positions ``(..., J, 3)`` and rotations ``(..., J, 3, 3)`` of a rig, file units, addressed by
    role.
    """

    def __init__(self, positions: Array, rotations: Array, roles: RigRoles) -> None:
        self.positions = np.asarray(positions, dtype=np.float64)
        self.rotations = np.asarray(rotations, dtype=np.float64)
        self.roles = roles

    def at(self, role: str) -> Array:
        """Position ``(..., 3)`` of the joint that plays ``role``."""
        return np.asarray(self.positions[..., self.roles.joints[role], :])

    def bone(self, upper: str, lower: str) -> Array:
        """Vector ``(..., 3)`` from one role's joint to another's."""
        return self.at(lower) - self.at(upper)

    def hip_centre(self) -> Array:
        """Midpoint of the hip joints, ``(..., 3)``."""
        return 0.5 * (self.at("left_hip") + self.at("right_hip"))

    def across(self, part: str = "hip") -> Array:
        """Vector ``(..., 3)`` from the right to the left joint of a pair."""
        return self.bone(f"right_{part}", f"left_{part}")

    def trunk(self) -> Array:
        """Vector ``(..., 3)`` from the middle of the hips to the middle of the shoulders."""
        return 0.5 * (self.at("left_shoulder") + self.at("right_shoulder")) - self.hip_centre()

    def legs(self) -> Array:
        """Vector ``(..., 3)`` from the middle of the ankles to the middle of the hips."""
        return self.hip_centre() - 0.5 * (self.at("left_ankle") + self.at("right_ankle"))


def animated_pose(clip: RigClip, roles: RigRoles) -> RigPose:
    """All frames of ``clip``."""
    return RigPose(*clip.global_pose(), roles)


def still_pose(clip: RigClip, roles: RigRoles, local: FloatArray | None = None) -> RigPose:
    """One pose: the rest pose, or the one with the local rotations ``local`` ``(J, 3, 3)``."""
    local = clip.rest_rotations() if local is None else local
    offsets = clip.offsets.astype(np.float64)
    return RigPose(*fk(np.asarray(local, dtype=np.float64), offsets[0], offsets, clip.parents), roles)


def standing_axes(pose: RigPose) -> Array | None:
    """Body axes of a still pose: ``(3, 3)`` with the columns left, up, forward, or ``None``.

    ``None`` where the pose is not one that a person could stand in with the arms in a T, an A or along the
    body; then nothing is known about how its joints are turned.
    """
    up = _snapped(normalise(normalise(pose.trunk()) + normalise(pose.legs())), _SNAP_UP)
    left = pose.across()
    left = _snapped(normalise(left - (left @ up) * up), _SNAP_YAW)
    axes = np.stack([left, up, np.cross(left, up)], axis=-1)
    return axes if _stands(pose, axes) and _arms_known(pose, axes) else None


def _stands(pose: RigPose, axes: Array) -> bool:
    left, up, forward = axes.T
    bones = [
        normalise(-pose.bone(f"{s}_{a}", f"{s}_{b}")) for s in _SIDES for a, b in (("hip", "knee"), ("knee", "ankle"))
    ]
    upright = [normalise(pose.trunk()) @ up > 0.86, *(bone @ up > 0.76 for bone in bones)]
    level = [normalise(pose.across(part)) @ left > 0.9 for part in ("hip", "shoulder")]
    joints = pose.roles.joints
    toes = [pose.bone(f"{s}_ankle", f"{s}_foot") @ forward > 0 for s in _SIDES if f"{s}_foot" in joints]
    return all(upright) and all(level) and all(toes)


def _arms_known(pose: RigPose, axes: Array) -> bool:
    for side, outward in (("left", axes[:, 0]), ("right", -axes[:, 0])):
        upper = normalise(pose.bone(f"{side}_shoulder", f"{side}_elbow"))
        lower = normalise(pose.bone(f"{side}_elbow", f"{side}_wrist"))
        if upper @ axes[:, 1] > 0.5 or upper @ outward < -0.2 or abs(upper @ axes[:, 2]) > 0.6 or upper @ lower < 0.4:
            return False
    return True


def _snapped(direction: Array, cosine: float) -> Array:
    """``direction``, or the coordinate axis that it nearly is: a subject's asymmetry should not tilt the
    world.
    """
    axis = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    axis[largest] = np.sign(direction[largest])
    return axis if direction @ axis > cosine else direction
