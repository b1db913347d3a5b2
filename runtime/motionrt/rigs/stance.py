"""What retargeting must know of a rig, whichever way it goes: roles, a standing pose, alignments, the vertical."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.rotations import Array, normalise
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.alignment import Alignments, align_standing
from motionrt.rigs.axes import sides_agree, to_y_up
from motionrt.rigs.calibration import align_from_motion
from motionrt.rigs.clip import RigClip
from motionrt.rigs.elbows import align_elbows
from motionrt.rigs.human import require_person
from motionrt.rigs.pose import RigPose, animated_pose, standing_axes, still_pose
from motionrt.rigs.roles import RigRoles, assign_roles
from motionrt.rigs.tree import RigTree

_CROSSED = -0.5
"""Cosine between the lines of hips and shoulders below which one of them has its sides exchanged."""


@dataclass(frozen=True, eq=False)
class Stance:
    """A rig, understood.

    Attributes:
        roles: which joint plays which role of ``smpl24``.
        motion: all frames of its clip, in the file's axes.
        local: ``(J, 3, 3)`` local rotations of the standing pose; ``None`` where none is known.
        alignments: rotation of each joint that has a role against its counterpart in ``smpl24``.
        to_world: ``(3, 3)``, from the file's axes to Y up.
    """

    roles: RigRoles
    motion: RigPose
    local: FloatArray | None
    alignments: Alignments
    to_world: Array


def read_stance(
    clip: RigClip, mapping: Mapping[str, str] | None, poses: Sequence[FloatArray], roles: RigRoles | None = None
) -> Stance:
    """Find out what is needed to retarget.

    Args:
        clip: a humanoid rig with its animation.
        mapping: ``smpl24`` joint name -> rig joint name; may be partial.
        poses: local rotations ``(J, 3, 3)`` of poses that may be standing poses, the likeliest first. If none is, the
            animation says how the joints are turned.
        roles: which joint plays which role, if that is known already.

    Raises:
        RigError: the rig is no humanoid, or joints are missing or ambiguous.
    """
    roles = assign_roles(RigTree(clip), mapping) if roles is None else roles
    motion = animated_pose(clip, roles)
    if not np.isfinite(motion.positions).all():
        raise RigError("the clip holds positions that are not finite")
    sided = roles.sided
    if not _sides_given(mapping):
        roles = motion.roles = _one_sided(motion)
    local, still, axes = _standing(clip, roles, poses)
    to_world = to_y_up(clip.up, motion, axes)
    if not mapping:
        require_person(RigTree(clip), motion, to_world[1], stands=axes is not None, sided=sided)
    if still is not None and axes is not None:
        alignments = align_elbows(motion, align_standing(still, axes))
    else:
        alignments = align_from_motion(motion, to_world.T[:, 1])
    return Stance(roles, motion, local, alignments, to_world)


def _one_sided(motion: RigPose) -> RigRoles:
    """One decision for the whole figure: legs as the body faces, arms on the side of the legs."""
    roles = motion.roles if sides_agree(motion) else motion.roles.swapped()
    facing = RigPose(motion.positions, motion.rotations, roles)
    crossed = (normalise(facing.across()) * normalise(facing.across("shoulder"))).sum(-1)
    return roles.swapped_arms() if np.median(crossed) < _CROSSED else roles


def _sides_given(mapping: Mapping[str, str] | None) -> bool:
    return any(role.startswith(("left_", "right_")) for role in mapping or {})


def _standing(
    clip: RigClip, roles: RigRoles, poses: Sequence[FloatArray]
) -> tuple[FloatArray | None, RigPose | None, Array | None]:
    """The first of ``poses`` that is a known standing pose: local rotations, pose, body axes."""
    for local in poses:
        pose = still_pose(clip, roles, local)
        axes = standing_axes(pose)
        if axes is not None:
            return local, pose, axes
    return None, None, None
