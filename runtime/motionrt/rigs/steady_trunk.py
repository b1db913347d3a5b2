"""Pelvis and chest by what hangs on them, where their own joints turn and the body does not.

In some rigs a joint's rotation is cancelled by joints of no length below it, or the hips are moved on their own. Then
the rotation of the joint says nothing about the body; the joints that carry its bones, and the lines of the hips and
shoulders, do.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, normalise, rotation_between
from motionrt.rigs.clip import RigClip
from motionrt.rigs.pose import RigPose, still_pose
from motionrt.rigs.stance import Stance
from motionrt.rigs.tree import RigTree

_CANCELLED = np.deg2rad(5.0)
"""Usual angle between a joint and the joints that carry its bones from which on the carriers are believed ..."""

_TOGETHER = np.deg2rad(5.0)
"""... if they turn together within this angle."""

_OFF_LINE = {"hip": np.deg2rad(6.0), "shoulder": np.deg2rad(25.0)}
"""Usual angle between the posed line of a pair and where the trunk has it; collars move shoulders by themselves."""


def with_steady_trunk(clip: RigClip, stance: Stance) -> RigPose:
    """``stance.motion`` with the rotations of pelvis and chest that the body has, where their joints have others."""
    motion, joints = stance.motion, stance.roles.joints
    still = still_pose(clip, stance.roles, stance.local)
    tree = RigTree(clip)
    rotations = motion.rotations
    for top, pair in ((joints["pelvis"], "hip"), ((stance.roles.spine or (joints["pelvis"],))[-1], "shoulder")):
        steady = _carried(tree, motion, still, top, pair)
        steady = _on_line(steady, motion, still, top, pair) if stance.local is not None else steady
        if steady is not motion.rotations:
            rotations = rotations.copy() if rotations is motion.rotations else rotations
            rotations[:, top] = steady[:, top]
    return motion if rotations is motion.rotations else RigPose(motion.positions, rotations, stance.roles)


def _carried(tree: RigTree, motion: RigPose, still: RigPose, top: int, pair: str) -> Array:
    """Rotations of all joints, with that of ``top`` taken from the joints at its place that carry both limbs."""
    carriers = [_carrier(tree, top, motion.roles.joints[f"{side}_{pair}"]) for side in ("left", "right")]
    if top in carriers:
        return motion.rotations
    one, two = (motion.rotations[:, joint] @ still.rotations[joint].T @ still.rotations[top] for joint in carriers)
    if _angle(one, two) > _TOGETHER or _angle(motion.rotations[:, top], one) < _CANCELLED:
        return motion.rotations
    out = motion.rotations.copy()
    out[:, top] = one
    return out


def _carrier(tree: RigTree, top: int, end: int) -> int:
    """The last joint on the way from ``top`` to ``end`` that stands where ``top`` does."""
    here = top
    for joint in tree.path(top, end):
        if tree.lengths[joint] > tree.negligible:
            break
        here = joint
    return here


def _on_line(rotations: Array, motion: RigPose, still: RigPose, top: int, pair: str) -> Array:
    """``rotations`` with ``top`` turned to where the posed line of a pair is, if it usually is elsewhere."""
    expected = rotations[:, top] @ (still.rotations[top].T @ normalise(still.across(pair)))
    line = normalise(motion.across(pair))
    if np.median(np.arccos(np.clip((expected * line).sum(-1), -1, 1))) < _OFF_LINE[pair]:
        return rotations
    out = rotations.copy()
    out[:, top] = rotation_between(expected, line) @ rotations[:, top]
    return out


def _angle(one: Array, two: Array) -> float:
    """Usual angle in radians between rotations ``(F, 3, 3)``."""
    trace = (one * two).sum((-2, -1))
    return float(np.median(np.arccos(np.clip((trace - 1) / 2, -1, 1))))
