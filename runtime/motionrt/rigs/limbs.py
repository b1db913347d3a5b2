"""Bone directions of the limbs: the target's are made the rig's, frame by frame."""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, rotation_between
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.alignment import SIDES, rest_direction
from motionrt.rigs.pose import RigPose

_SWUNG = (("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "hand"))


def swing_limbs(turned: Array, world: RigPose) -> None:
    """Turn each limb bone by the little that it lacks to point where the rig's bone points.

    Args:
        turned: global target rotations ``(F, 24, 3, 3)``, changed in place.
        world: the rig in the same axes.
    """
    for side in SIDES:
        for upper, lower in _SWUNG:
            role, end = f"{side}_{upper}", f"{side}_{lower}"
            if end in world.roles.joints:
                joint = SMPL24.index(role)
                now = turned[:, joint] @ rest_direction(role, end)
                bone = world.bone(role, end)
                exists = np.linalg.norm(bone, axis=-1, keepdims=True) > 1e-9
                turned[:, joint] = rotation_between(now, np.where(exists, bone, now)) @ turned[:, joint]
