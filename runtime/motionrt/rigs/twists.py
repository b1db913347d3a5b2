"""How far the limbs of a rig are turned about their own length against those of a probe: part of its certification.

A leg that stands is bent so that its foot is where the probe's is. On a rig with wider hips it leans, and then its
rotation cannot be that of the probe; what must hold is that the knee bends about its own hinge and points where that
of the probe points.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.plain_kinematics import angles_between
from motionrt.rigs.played import Played

_SIDES = ("left", "right")
_LEGS, _ARMS = ("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist")
_BENT = 20.0
"""Degrees that a knee bends from which on the plane of the bend is known."""


def twists(motion: Motion, played: Played, standing: npt.NDArray[np.bool_]) -> Array:
    """Turns ``(8, F)`` in degrees, around their median: arms, then legs, of each side the upper limb and the lower.

    Args:
        motion: the probe.
        played: the probe on the rig.
        standing: ``(4, F or 1)``, whether the foot of each leg bone is near the floor.
    """
    arms, legs, planes = _against(motion, played, _ARMS), _against(motion, played, _LEGS), _planes(motion, played)
    planted = np.isfinite(planes) & standing
    return np.concatenate([_from_median(arms), np.where(planted, planes, _from_median(legs, ~planted))])


def _from_median(turns: Array, where: npt.NDArray[np.bool_] | bool = True) -> Array:
    """``|turns|`` around the median of each row over the frames that count, or over all where none does."""
    counted = np.where(where, turns, np.nan)
    counted = np.where(np.isfinite(counted).any(axis=-1, keepdims=True), counted, turns)
    return np.asarray(np.abs(turns - np.nanmedian(counted, axis=-1, keepdims=True)))


def _against(motion: Motion, played: Played, line: tuple[str, str, str]) -> Array:
    """Turns ``(4, F)`` about the bone of the rig's rotations against the probe's, since the first frame."""
    ours = motion.global_rotations().astype(np.float64)
    rows = []
    for side in _SIDES:
        for upper, lower in ((f"{side}_{line[0]}", f"{side}_{line[1]}"), (f"{side}_{line[1]}", f"{side}_{line[2]}")):
            joint, theirs = SMPL24.index(upper), played.turns[:, played.roles[upper]]
            relative = np.swapaxes(ours[:, joint], -1, -2) @ theirs
            change = relative @ np.swapaxes(relative[:1], -1, -2)
            bone = SMPL24.offsets[SMPL24.index(lower)].astype(np.float64)
            rows.append(_turn_about(change, bone / np.linalg.norm(bone)))
    return np.stack(rows)


def _turn_about(rotations: Array, axis: Array) -> Array:
    """Signed angle in degrees of the part of ``(F, 3, 3)`` that turns about ``axis``  [swing-twist decomposition]."""
    skew = np.stack(
        [
            rotations[:, 2, 1] - rotations[:, 1, 2],
            rotations[:, 0, 2] - rotations[:, 2, 0],
            rotations[:, 1, 0] - rotations[:, 0, 1],
        ],
        axis=-1,
    )
    return np.asarray(np.degrees(2 * np.arctan2(skew @ axis, 1 + np.trace(rotations, axis1=-2, axis2=-1))))


def _planes(motion: Motion, played: Played) -> Array:
    """Turns ``(4, F)`` of thighs and shanks, whichever is larger: of the hinge against the bend of the knee, around its
    median, or of the way that the knee points against the probe's, seen along the leg. NaN where a knee hardly bends.
    """
    source = motion.positions().astype(np.float64)
    rows = []
    for side in _SIDES:
        hip, knee, ankle = (source[:, SMPL24.index(f"{side}_{part}")] for part in _LEGS)
        theirs = played.bone(f"{side}_hip", f"{side}_knee"), played.bone(f"{side}_knee", f"{side}_ankle")
        bent = _bends(knee - hip, ankle - knee) & _bends(*theirs)
        off = np.abs(_angle_about(_pointing(knee - hip, ankle - knee), _pointing(*theirs), theirs[0] + theirs[1]))
        for part, bone in zip(("hip", "knee"), theirs, strict=True):
            back = np.swapaxes(played.turns[:, played.roles[f"{side}_{part}"]], -1, -2)
            hinge = (back @ np.cross(*theirs)[..., None])[..., 0]
            steady = np.broadcast_to(np.median(hinge[bent], axis=0) if bent.any() else hinge[0], hinge.shape)
            turned = np.abs(_angle_about(steady, hinge, (back @ bone[..., None])[..., 0]))
            rows.append(np.where(bent, np.maximum(turned, off), np.nan))
    return np.stack(rows)


def _bends(upper: Array, lower: Array) -> npt.NDArray[np.bool_]:
    """``(F,)``: whether a limb bends enough to have a plane."""
    return np.asarray(angles_between(upper, lower) > _BENT)


def _pointing(upper: Array, lower: Array) -> Array:
    """Vectors ``(F, 3)`` from the line between the ends of a limb to its middle joint."""
    line = upper + lower
    share = (upper * line).sum(axis=-1, keepdims=True) / np.maximum((line * line).sum(axis=-1, keepdims=True), 1e-12)
    return np.asarray(upper - share * line)


def _angle_about(one: Array, two: Array, axis: Array) -> Array:
    """Signed angles ``(F,)`` in degrees from ``one`` to ``two``, both seen along ``axis``."""
    along = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
    flat = [v - (v * along).sum(axis=-1, keepdims=True) * along for v in (one, two)]
    sine = (np.cross(flat[0], flat[1]) * along).sum(axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, (flat[0] * flat[1]).sum(axis=-1))))
