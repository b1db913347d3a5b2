"""A :class:`Motion` from the joints of a body of any size: what text-to-motion models and pose trackers give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.motion.from_positions import checked_joints, from_positions
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, lengths, normalise
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24
from motionrt.rigs.placement import place_root
from motionrt.rigs.pose import RigPose
from motionrt.rigs.roles import RigRoles

_ROLES = RigRoles({SMPL24.names[joint]: joint for joint in range(SMPL22_JOINTS)}, (3, 6, 9), (12, 15), sided=True)


def motion_of_body(joints: Array, fps: float) -> Motion:
    """A motion whose bones point as those between the positions; its path is scaled by the length of the legs.

    Args:
        joints: ``(F, 22 or 24, 3)`` joints in the order of ``smpl24``, Y up, any unit and proportions.
        fps: frames per second.

    Raises:
        InvalidInputError: another shape, or numbers that are not finite.
    """
    given = checked_joints(joints)[:, :SMPL22_JOINTS]
    motion = from_positions(_resized(given), fps)
    pose = RigPose(given, np.zeros((*given.shape, 3)), _ROLES)
    root = place_root(motion.global_rotations().astype(np.float64), pose, fps)
    return replace(motion, root=root.astype(np.float32))


def _resized(joints: Array) -> Array:
    """Positions ``(F, 22, 3)`` of a body with the bones of ``smpl24`` that point as those of ``joints``."""
    bones, out = lengths(SMPL24.offsets.astype(np.float64)), np.zeros_like(joints)
    for joint, parent in enumerate(SMPL24.parents[:SMPL22_JOINTS]):
        if parent >= 0:
            out[:, joint] = out[:, parent] + bones[joint] * normalise(joints[:, joint] - joints[:, parent])
    return out
