"""Which way the joints of a user's rig are turned when ``smpl24`` is in a pose: ``alignment`` backwards."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.rotations import Array, matrix_to_quaternion, quaternion_to_matrix, rotation_between, slerp
from motionrt.motion.skeleton import SMPL24, FloatArray
from motionrt.rigs.alignment import SIDES, rest_direction
from motionrt.rigs.clip import RigClip
from motionrt.rigs.pose import RigPose, still_pose
from motionrt.rigs.stance import Stance

Turned = dict[int, Array]
"""Rig joint -> global rotations ``(F, 3, 3)``, Y up; float32, since long motions fill the memory."""

_SWUNG = (("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist"))
_TRUNK, _NECK = ("pelvis", "spine1", "spine2", "spine3"), ("spine3", "neck", "head")


def drive(turned: FloatArray, clip: RigClip, stance: Stance, local: FloatArray) -> Turned:
    """Global rotations of the joints that have a role, Y up.

    Trunk and neck of any number of joints share the turns of ``smpl24`` evenly, limbs point exactly where its limbs
    point. Fingers, twist bones and all else is not in the result: it stays as it is against its parent.

    Args:
        turned: global rotations ``(F, 24, 3, 3)`` of ``smpl24``.
        clip: the rig.
        stance: what is known of it.
        local: ``(J, 3, 3)`` local rotations of the pose in which uncast joints stay.
    """
    out = _counterparts(turned, stance)
    for joint in out:
        out[joint] = stored(lambda part, to=stance.alignments[joint].T: part @ to, out[joint])
    still = still_pose(clip, stance.roles, local)
    for side in SIDES:
        for upper, lower in _SWUNG:
            _swing(out, turned, still, f"{side}_{upper}", f"{side}_{lower}")
    return out


def stored(function: Callable[..., Array], *arrays: Array) -> Array:
    """``function`` of all frames, worked out with 64 bits and kept with 32."""
    wide = partial(np.asarray, dtype=np.float64)
    return by_batches(lambda *parts: function(*map(wide, parts)).astype(np.float32), *arrays)


def _counterparts(turned: FloatArray, stance: Stance) -> Turned:
    """For every joint to be driven, what ``smpl24`` does there."""
    joints = stance.roles.joints
    out = {
        joint: _of(turned, role)
        for role, joint in joints.items()
        if joint in stance.alignments and not role.endswith("_hand") and not role.startswith(("spine", "neck", "head"))
    }
    trunk = (joints["pelvis"], *stance.roles.spine)
    chest = trunk[-1]
    for line, chain in ((trunk, _TRUNK), ((chest, *stance.roles.neck), _NECK)):
        for place, joint in enumerate(line[1:], start=1):
            if joint in stance.alignments:
                out[joint] = _between(turned, chain, place / (len(line) - 1))
    for role in ("spine1", "spine2", "spine3", "neck"):  # joints that the user has mapped
        if joints.get(role) in stance.alignments:
            out[joints[role]] = _of(turned, role)
    return out


def _between(turned: FloatArray, chain: tuple[str, ...], share: float) -> Array:
    """Rotations ``(F, 3, 3)`` at ``share`` (0 to 1) of a chain of ``smpl24`` joints, by slerp."""
    place = share * (len(chain) - 1)
    below = min(int(place + 1e-9), len(chain) - 2)
    lower, upper = (_of(turned, name) for name in chain[below : below + 2])
    weight = place - below
    if weight < 1e-6 or weight > 1 - 1e-6:
        return np.asarray(lower if weight < 0.5 else upper)
    return by_batches(partial(_share, weight), lower, upper)


def _share(weight: float, lower: Array, upper: Array) -> Array:
    start, end = matrix_to_quaternion(lower), matrix_to_quaternion(upper)
    return quaternion_to_matrix(slerp(start, end, np.full(len(start), weight)))


def _of(turned: FloatArray, role: str) -> Array:
    """Global rotations ``(F, 3, 3)`` of one joint of ``smpl24``."""
    return turned[:, SMPL24.index(role)]


def _swing(out: Turned, turned: FloatArray, still: RigPose, role: str, end: str) -> None:
    """Turn a limb bone by the little that it lacks to point where that of ``smpl24`` points."""
    joint = still.roles.joints[role]
    bone = still.rotations[joint].T @ still.bone(role, end)
    if joint in out and np.linalg.norm(bone) > 1e-9:
        wanted = _of(turned, role) @ rest_direction(role, end)
        out[joint] = stored(lambda one, other: rotation_between(one @ bone, other) @ one, out[joint], wanted)
