"""How each joint of a rig is turned against its ``smpl24`` counterpart, read off one known standing pose.

With ``R_j`` the joint's global rotation in that pose and ``B_j`` the global rotation that the target joint
has when it stands in the same pose, the constant ``A_j = R_j^T B_j`` gives the target's rotation ``R_j(t)
A_j`` at any time.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from motionrt.motion.rotations import Array, normalise, rotation_between
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.pose import RigPose

Alignments = dict[int, Array]
"""Rig joint index -> ``A_j`` ``(3, 3)``, float64."""

SIDES = ("left", "right")
_SPREAD = np.deg2rad(13.0)
"""Shanks spread sideways by more than this (the CMU skeletons: 20 degrees) hang in the air, soles square to
them.
"""

_FLAT = (0.0, np.deg2rad(50.0))
"""Slope of ankle -> toe below the horizontal at which a still foot counts as flat on the floor."""


def rest_direction(upper: str, lower: str) -> Array:
    """Unit direction ``(3,)`` from one ``smpl24`` joint to another in the rest pose."""
    rest = SMPL24.rest_positions
    return np.asarray(normalise((rest[SMPL24.index(lower)] - rest[SMPL24.index(upper)]).astype(np.float64)))


def align_standing(pose: RigPose, axes: Array) -> Alignments:
    """Alignments from a standing pose.

    The trunk of a standing pose is neutral; the limbs swing from the target's T to the pose's directions,
    each bone on top of the one above it, so that no twist is invented; feet that stand flat stay flat and
    only turn.

    Args:
        pose: the still pose.
        axes: its body axes ``(3, 3)``, columns left, up, forward (see :func:`standing_axes`).
    """
    posed: dict[int, Array] = dict.fromkeys((*pose.roles.spine, *pose.roles.neck), axes)
    joints = pose.roles.joints
    posed.update({joint: axes for role, joint in joints.items() if "_" not in role or role.endswith("collar")})
    for side in SIDES:
        _pose_limb(pose, axes, side, ("hip", "knee", "ankle"), posed)
        _pose_limb(pose, axes, side, ("shoulder", "elbow", "wrist", "hand"), posed)
        _pose_foot(pose, axes, side, posed)
    return {joint: pose.rotations[joint].T @ turned for joint, turned in posed.items()}


def _pose_limb(pose: RigPose, axes: Array, side: str, line: tuple[str, ...], posed: dict[int, Array]) -> None:
    turned = axes
    for upper, lower in pairwise(line):
        role, end = f"{side}_{upper}", f"{side}_{lower}"
        if end in pose.roles.joints:
            bone = pose.bone(role, end)
            turned = rotation_between(turned @ rest_direction(role, end), bone) @ turned
        posed[pose.roles.joints[role]] = turned
    if f"{side}_{line[-1]}" in pose.roles.joints:
        posed[pose.roles.joints[f"{side}_{line[-1]}"]] = turned


def _pose_foot(pose: RigPose, axes: Array, side: str, posed: dict[int, Array]) -> None:
    ankle, toe = f"{side}_ankle", f"{side}_foot"
    turned = _foot_axes(pose, axes, side)
    if toe in pose.roles.joints:
        turned = foot_rotation(pose.bone(ankle, toe), turned, ankle, toe)
        posed[pose.roles.joints[toe]] = turned
    posed[pose.roles.joints[ankle]] = turned


def _foot_axes(pose: RigPose, axes: Array, side: str) -> Array:
    """Body axes, or those axes tilted sideways with a shank that is spread so far that its sole cannot be
    level.
    """
    shank = pose.bone(f"{side}_ankle", f"{side}_knee")
    _, up, forward = axes.T
    frontal = normalise(shank - (shank @ forward) * forward)
    spread = np.arccos(np.clip(frontal @ up, -1, 1))
    return np.asarray(rotation_between(up, frontal) @ axes) if spread > _SPREAD else axes


def foot_rotation(bone: Array, axes: Array, ankle: str, toe: str) -> Array:
    """Global rotation of the target foot for a still foot ``bone`` ``(3,)``: by yaw alone if it is flat."""
    _, up, forward = axes.T
    rise = normalise(bone) @ up
    flat = bone - (bone @ up) * up
    if not _FLAT[0] <= -np.arcsin(np.clip(rise, -1, 1)) <= _FLAT[1]:
        return np.asarray(rotation_between(axes @ rest_direction(ankle, toe), bone) @ axes)
    return np.asarray(rotation_between(forward, flat) @ axes)


def role_rotations(pose: RigPose, alignments: Mapping[int, Array], joint: int) -> Array:
    """Global rotations ``(F, 3, 3)`` of the target where it follows rig joint ``joint``, in file axes."""
    return np.asarray(pose.rotations[..., joint, :, :] @ alignments[joint])
