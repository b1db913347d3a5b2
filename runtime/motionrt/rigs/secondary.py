"""Joints of a user's rig that ``smpl24`` lacks: fingers hang relaxed, twist bones take their share of a turn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from motionrt.motion.rotations import Array, axis_angle_to_matrix, normalise
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.alignment import SIDES
from motionrt.rigs.clip import RigClip
from motionrt.rigs.drive import Turned
from motionrt.rigs.joint_names import words_of
from motionrt.rigs.pose import RigPose, still_pose
from motionrt.rigs.stance import Stance
from motionrt.rigs.tree import RigTree

_FINGERS = frozenset({"index", "middle", "mid", "ring", "pinky", "pinkie", "little"})
_TWISTS = frozenset({"twist", "twst", "roll"})
_CURL = (0.35, 0.5, 0.35)
"""Radians that a relaxed finger bends at its three joints."""

_SPREAD = np.cos(np.deg2rad(12.0))
"""Fingers that bend by more than this at rest are relaxed already, or hold something."""

_ASIDE = 0.1
"""Share of a bone that a joint may stand beside its line to turn about it without moving what hangs on it."""


def relaxed(clip: RigClip, stance: Stance, local: FloatArray) -> FloatArray:
    """``local`` ``(J, 3, 3)`` with fingers that are stretched at rest bent a little towards the palm; not the thumbs.

    The palm of an arm that is held out faces the floor, that of a hanging arm the thigh.
    """
    tree, still = RigTree(clip), still_pose(clip, stance.roles, local)
    out = local.astype(np.float64)
    for side in SIDES:
        wrist = stance.roles.joints[f"{side}_wrist"]
        other = still.bone("right_shoulder", "left_shoulder") * (1 if side == "left" else -1)
        palm = -stance.to_world[1] - 0.5 * normalise(other)
        for finger in _fingers(tree, wrist):
            _curl(out, still, finger, palm)
    return out.astype(np.float32)


def _fingers(tree: RigTree, wrist: int) -> list[list[int]]:
    """Lines of joints from knuckle to tip that the names call fingers."""
    below = [joint for joint in tree.descendants(wrist) if _FINGERS & set(words_of(tree.names[joint]))]
    named = [joint for joint in below if "metacarpal" not in words_of(tree.names[joint])]
    starts = [joint for joint in named if tree.parents[joint] not in named]
    return [[joint, *(other for other in named if tree.is_above(joint, other))] for joint in starts]


def _curl(out: Array, still: RigPose, finger: list[int], palm: Array) -> None:
    places = still.positions[finger]
    bones = normalise(np.diff(places, axis=0))
    if len(finger) < 2 or (len(bones) > 1 and (bones[1:] * bones[:-1]).sum(-1).min() < _SPREAD):
        return
    axis = np.cross(bones[0], palm)
    if np.linalg.norm(axis) < 1e-6:
        return
    for joint, angle in zip(finger, _CURL, strict=False):
        turned = still.rotations[joint]
        out[joint] = out[joint] @ axis_angle_to_matrix(angle * (turned.T @ normalise(axis)))


def share_twists(turned: Turned, clip: RigClip, stance: Stance, local: FloatArray) -> None:
    """Add twist bones to the driven joints ``turned``, in place.

    Those of forearm and shank turn with hand and foot, the more the nearer they are to them: twist bones by their name,
    and all joints inside the bone. Those of upper arm and thigh, by their name, are turned back towards the trunk, the
    more the nearer they are to it.
    """
    tree, still = RigTree(clip), still_pose(clip, stance.roles, local)
    joints = stance.roles.joints
    for side in SIDES:
        for upper, middle, end in (("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")):
            top, hinge, last = (joints[f"{side}_{part}"] for part in (upper, middle, end))
            _lower(turned, tree, still, hinge, last)
            _upper(turned, tree, still, top, hinge)


def _lower(turned: Turned, tree: RigTree, still: RigPose, hinge: int, last: int) -> None:
    inside = set(tree.path(hinge, last)[:-1])
    beside = {joint for joint in tree.children[hinge] if _is_twist(tree, joint) and joint != last}
    if hinge not in turned or last not in turned or not inside | beside:
        return
    before = still.rotations[hinge].T @ still.rotations[last]
    angle = _twist(np.swapaxes(turned[hinge], -1, -2) @ turned[last] @ before.T, _along(still, hinge, last))
    for joint, share in _shares(still, hinge, last, inside | beside).items():
        _turn(turned, still, hinge, joint, _along(still, hinge, last), share * angle)


def _upper(turned: Turned, tree: RigTree, still: RigPose, top: int, hinge: int) -> None:
    beside = {joint for joint in tree.children[top] if _is_twist(tree, joint) and not tree.is_above(joint, hinge)}
    above = next((joint for joint in tree.ancestors(top)[1:] if joint in turned), None)
    if top not in turned or above is None or not beside:
        return
    before = still.rotations[above].T @ still.rotations[top]
    angle = _twist(before.T @ np.swapaxes(turned[above], -1, -2) @ turned[top], _along(still, top, hinge))
    for joint, share in _shares(still, top, hinge, beside).items():
        _turn(turned, still, top, joint, _along(still, top, hinge), (share - 1) * angle)


def _is_twist(tree: RigTree, joint: int) -> bool:
    return not _TWISTS.isdisjoint(words_of(tree.names[joint]))


def _along(still: RigPose, upper: int, lower: int) -> Array:
    """Unit vector ``(3,)`` from a joint to another, in the frame of the former."""
    return normalise(still.rotations[upper].T @ (still.positions[lower] - still.positions[upper]))


def _shares(still: RigPose, upper: int, lower: int, joints: set[int]) -> Mapping[int, float]:
    """How far along the bone each joint stands, 0 to 1; only joints on its line."""
    bone = still.positions[lower] - still.positions[upper]
    length = float(np.linalg.norm(bone))
    out = {}
    for joint in joints:
        way = still.positions[joint] - still.positions[upper]
        share = float(way @ bone) / max(length**2, 1e-12)
        if np.linalg.norm(way - share * bone) <= _ASIDE * length:
            out[joint] = min(max(share, 0.0), 1.0)
    return out


def _turn(turned: Turned, still: RigPose, base: int, joint: int, axis: Array, angle: Array) -> None:
    rest = still.rotations[base].T @ still.rotations[joint]
    turned[joint] = turned[base] @ axis_angle_to_matrix(angle[:, None] * axis) @ rest


def _twist(rotations: Array, axis: Array) -> Array:
    """Angles ``(F,)`` in radians by which rotations turn about an axis, without jumps  [swing-twist decomposition]."""
    skew = np.stack(
        [
            rotations[:, 2, 1] - rotations[:, 1, 2],
            rotations[:, 0, 2] - rotations[:, 2, 0],
            rotations[:, 1, 0] - rotations[:, 0, 1],
        ],
        axis=-1,
    )
    return np.unwrap(2 * np.arctan2(skew @ axis, 1 + np.trace(rotations, axis1=-2, axis2=-1)))
