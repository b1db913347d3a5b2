"""Elbows bend about the target's own hinge, whichever way a rig's rest pose has its upper arms turned.

A T-pose does not say how the upper arm is turned about its length: in the CMU skeletons the elbow's axis
stands 30 degrees off the vertical. Left as it is, the same movement would have other arm rotations from every
rig.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, axis_rotation, normalise
from motionrt.rigs.alignment import SIDES, Alignments, role_rotations
from motionrt.rigs.pose import RigPose

_TOLERATED = np.deg2rad(15.0)
"""A rig whose hinge is this near to the target's is left alone, so that what motionrt wrote comes back as it
was.
"""

_SURE = 0.9
_BENT = 0.05


def align_elbows(motion: RigPose, alignments: Alignments) -> Alignments:
    """``alignments`` with upper arms and forearms turned about their length until the elbows' axis is the
    target's.

    One angle for the rig, mirrored between the sides; nothing changes where the elbows have no steady axis or
    hardly bend.
    """
    hinges = np.concatenate(
        [_hinges(motion, alignments, side, part) for side in SIDES for part in ("shoulder", "elbow")]
    )
    mean = hinges.mean(axis=0)
    sizes = np.linalg.norm(hinges, axis=-1).mean()
    tilt = float(np.arctan2(mean[2], mean[1]))
    if sizes < _BENT or np.linalg.norm(mean) < _SURE * sizes or abs(tilt) < _TOLERATED:
        return alignments
    turned = dict(alignments)
    for side in SIDES:
        for part in ("shoulder", "elbow"):
            joint = motion.roles.joints[f"{side}_{part}"]
            turned[joint] = turned[joint] @ axis_rotation("X", np.float64(tilt))
    return turned


def _hinges(motion: RigPose, alignments: Alignments, side: str, part: str) -> Array:
    """Elbow axis times the sine of the bend, ``(F, 3)``, in the target's upper arm or forearm; +Y where it is
    ideal.
    """
    upper = normalise(motion.bone(f"{side}_shoulder", f"{side}_elbow"))
    lower = normalise(motion.bone(f"{side}_elbow", f"{side}_wrist"))
    hinge = np.cross(upper, lower) * (-1 if side == "left" else 1)
    turned = role_rotations(motion, alignments, motion.roles.joints[f"{side}_{part}"])
    return np.asarray(np.einsum("fji,fj->fi", turned, hinge))
