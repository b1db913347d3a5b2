"""The build of a user's rig in metres of ``smpl24``: where its legs are, how long, how high it stands on its feet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL24, FloatArray
from motionrt.rigs.alignment import SIDES
from motionrt.rigs.clip import RigClip
from motionrt.rigs.placement import leg_scale
from motionrt.rigs.pose import RigPose, still_pose
from motionrt.rigs.stance import Stance

_FOOT = SMPL24.offsets[SMPL24.index("left_foot")].astype(np.float64)
_HIGHEST_TOE = 0.10  # metres above zero up to which the toes of a rest pose stand on a floor at zero
_LONGEST_LEG = 20.0  # times the shortest bone of the legs


@dataclass(frozen=True, eq=False)
class Build:
    """Lengths in metres of ``smpl24``: units of the rig divided by ``units``.

    Attributes:
        units: units of the rig per metre, by the length of the legs.
        thighs, shanks, feet: ``(2, 3)`` from joint to joint (foot: ankle to toe joint), left and right, in the frames
            of hip, knee and ankle joint.
        hips: ``(2, 3)`` from the pelvis to the hip joints, in the frame of the pelvis.
        sole: height of the toe joints above the floor where the rig stands on its soles.
        rise: how much higher above the toe joint its ankle is than that of ``smpl24``, while it stands flat.
        ahead: how much farther ahead of the ankle its toe joint is.
    """

    units: float
    thighs: Array
    shanks: Array
    feet: Array
    hips: Array
    sole: float
    rise: float
    ahead: float


def read_build(clip: RigClip, stance: Stance, local: FloatArray) -> Build:
    """Measure ``clip`` in the pose of local rotations ``local``.

    Raises:
        RigError: a leg bone has no length.
    """
    still = still_pose(clip, stance.roles, local)
    units = 1 / leg_scale(still)
    thighs = _bones(still, "hip", "knee") / units
    shanks = _bones(still, "knee", "ankle") / units
    lengths = np.linalg.norm([thighs, shanks], axis=-1)
    if lengths.min() * _LONGEST_LEG < lengths.max():
        raise RigError("a thigh or a shank of the rig has no length; name other joints with mapping=")
    turns = np.stack([stance.alignments[stance.roles.joints[f"{side}_ankle"]] for side in SIDES])
    feet = _feet(still, turns, units)
    flat = np.einsum("sba,sb->sa", turns, feet).mean(axis=0)  # the feet of smpl24's T-pose
    sole = _sole(still, stance, units)
    hips = np.stack([_within(still, "pelvis", f"{side}_hip") for side in SIDES]) / units
    return Build(units, thighs, shanks, feet, hips, sole, float(_FOOT[1] - flat[1]), float(flat[2] - _FOOT[2]))


def _bones(still: RigPose, upper: str, lower: str) -> Array:
    return np.stack([_within(still, f"{side}_{upper}", f"{side}_{lower}") for side in SIDES])


def _within(still: RigPose, role: str, end: str) -> Array:
    """From the joint of ``role`` to that of ``end``, in the frame of the former."""
    return np.asarray(still.rotations[still.roles.joints[role]].T @ still.bone(role, end))


def _feet(still: RigPose, turns: Array, units: float) -> Array:
    """Ankle to toe joint; a rig without toe joints gets the feet of ``smpl24``."""
    if all(f"{side}_foot" in still.roles.joints for side in SIDES):
        return _bones(still, "ankle", "foot") / units
    return np.asarray(turns @ _FOOT)


def _sole(still: RigPose, stance: Stance, units: float) -> float:
    """Height of the toe joints above the floor: in the rest pose if that stands on zero, else in the file's motion.

    0 where neither tells, or there are no toe joints.
    """
    joints = still.roles.joints
    if not all(f"{side}_foot" in joints for side in SIDES):
        return 0.0
    for pose in (still, stance.motion):
        heights = np.stack([pose.at(f"{side}_foot") @ stance.to_world[1] for side in SIDES]) / units
        lowest = float(np.percentile(heights.min(axis=0), 2))
        if 0 <= lowest <= _HIGHEST_TOE:
            return lowest
    return 0.0
