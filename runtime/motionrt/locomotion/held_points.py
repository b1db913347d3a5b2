"""Held poses meet their keypoints also when the feet have been locked: pelvis, arms and legs are solved together.

Locking a foot may lower the pelvis, and a hand then leaves what it holds. Here the pelvis goes back as far as the
keypoints ask for, hands and feet reach by two-bone inverse kinematics, and feet that no keypoint speaks of stay where
they stand. What is corrected fades in before a hold and out behind it; a foot that has to go elsewhere is lifted
meanwhile, and stays between two holds that want it in the same place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.two_bone import LEG_JOINTS, two_bone
from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import Array

FADE = 15  # frames over which a correction comes and goes
ROUNDS = 4  # of limbs and pelvis in turn
LIFTED, FAR = 0.05, 0.02  # metres that a foot is lifted that has to go farther than so many metres
BRIDGED, SAME = 70, 0.05  # frames between holds and metres between their points over which a foot stays
GIVES = 0.9  # share of what limbs miss that the pelvis follows in a round
FARTHEST = 0.12  # metres that a pelvis follows in all
_LIMBS = {
    **{f"{side}_{end}": tuple(SMPL24.index(f"{side}_{name}") for name in ("shoulder", "elbow", "wrist", end))
       for side in ("left", "right") for end in ("wrist", "hand")},
    **{f"{side}_{end}": (*LEG_JOINTS[number][:3], SMPL24.index(f"{side}_{end}"))
       for number, side in enumerate(("left", "right")) for end in ("ankle", "foot")},
}  # fmt: skip

_FEET = ("left_ankle", "right_ankle", "left_foot", "right_foot")

Points = Mapping[str, Sequence[float]]
Hold = tuple[int, int, Points]
"""First frame, the one behind the last, and {joint: (x, y, z) metres} of a held pose."""
Values = npt.NDArray[np.float64]


def hold_points(motion: Motion, holds: Sequence[Hold]) -> Motion:
    """The motion with the keypoints of its holds met.

    Args:
        motion: on ``smpl24``, feet as they shall stay.
        holds: first frame, the one behind the last, and {joint: (x, y, z) metres} of each held pose.
    """
    rotations, root = motion.rotations.astype(np.float64), motion.root.astype(np.float64)
    rotations = _with_feet(rotations, root, holds)
    for start, end, points in holds:
        own = {name: point for name, point in points.items() if name not in _FEET}
        if own:
            first, last = max(0, start - FADE), min(motion.frames, end + FADE)
            weight = held_weight(np.arange(first, last), start, end)
            rotations[first:last], root[first:last] = _met(rotations[first:last], root[first:last], own, weight)
    return replace(motion, rotations=rotations.astype(np.float32), root=root.astype(np.float32))


def held_weight(now: npt.NDArray[np.int_], start: int, end: int) -> Values:
    """1 in a hold, fading to 0 around it."""
    outside = np.minimum(np.maximum(np.maximum(start - now, now - (end - 1)), 0) / (FADE + 1), 1.0)
    return np.asarray((1 - outside) ** 2 * (1 + 2 * outside))


def _with_feet(rotations: Values, root: Values, holds: Sequence[Hold]) -> Values:
    """Legs bent so that feet are at their keypoints while poses are held."""
    out, now = rotations, np.arange(len(root))
    for name in _FEET:
        spans = _spans([(start, end, points[name]) for start, end, points in holds if name in points])
        for start, end, point in spans:
            first, last = max(0, start - FADE), min(len(root), end + FADE)
            part, place = out[first:last], root[first:last]
            weight = held_weight(now[first:last], start, end)
            aim = _drawn(places(part, place)[0], name, point, weight)
            far = np.linalg.norm(places(part, place)[0][:, SMPL24.index(name)] - point, axis=1)
            aim[:, 1] += LIFTED * np.sin(np.pi * weight) * np.clip(far / FAR - 1, 0, 1) * (weight < 1)
            out = np.concatenate([out[:first], reaching(part, place, _LIMBS[name], aim, pole_axis=2), out[last:]])
    return out.copy()


def _spans(holds: list[tuple[int, int, Sequence[float]]]) -> list[tuple[int, int, Values]]:
    """Holds of one foot, those that follow each other with the foot in the same place as one."""
    out: list[tuple[int, int, Values]] = []
    for start, end, point in holds:
        here = np.asarray(point, dtype=np.float64)
        if out and start - out[-1][1] <= BRIDGED and np.linalg.norm(out[-1][2] - here) < SAME:
            out[-1] = (out[-1][0], end, out[-1][2])
        else:
            out.append((start, end, here))
    return out


def _met(rotations: Values, root: Values, points: Points, weight: Values) -> tuple[Values, Values]:
    """Frames (F) whose joints are drawn to the points, each by its ``weight`` (F,)."""
    before = places(rotations, root)[0]
    standing = before[:, [leg[2] for leg in LEG_JOINTS]]
    aims = {name: _drawn(before, name, point, weight) for name, point in points.items() if name in SMPL24.names}
    moved = np.zeros_like(root)
    if "pelvis" in aims:
        moved = aims["pelvis"] - root
    out = rotations
    for _ in range(ROUNDS):
        out = _limbs(rotations, root + moved, standing, aims)
        joints = places(out, root + moved)[0]
        missed = [aims[name] - joints[:, SMPL24.index(name)] for name in aims if name in _LIMBS]
        if not missed or "pelvis" in aims:
            break
        moved = moved + GIVES * np.mean(missed, axis=0)
        moved *= np.minimum(1.0, FARTHEST / np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), 1e-9))
    return _limbs(rotations, root + moved, standing, aims), root + moved


def _drawn(joints: Values, name: str, point: npt.ArrayLike, weight: Values) -> Values:
    here = joints[:, SMPL24.index(name)]
    return np.asarray(here + weight[:, None] * (np.asarray(point, dtype=np.float64) - here))


def _limbs(rotations: Values, root: Values, standing: Values, aims: Mapping[str, Values]) -> Values:
    """Arms bent so that they reach their aims, legs so that feet stay where they stood."""
    out = rotations.copy()
    for number, leg in enumerate(LEG_JOINTS):
        out = reaching(out, root, (*leg[:3], leg[2]), standing[:, number], pole_axis=2)
    for side in ("left", "right"):
        named = next((f"{side}_{end}" for end in ("hand", "wrist") if f"{side}_{end}" in aims), None)
        if named:
            out = reaching(out, root, _LIMBS[named], aims[named], pole_axis=None)
    return out


def reaching(rotations: Values, root: Values, chain: Sequence[int], aim: Values, pole_axis: int | None) -> Values:
    """One limb whose end, carried along by its third joint, comes to ``aim`` (F, 3)."""
    joints, turned = places(rotations, root)
    upper, middle, last, end = chain
    target = aim - (joints[:, end] - joints[:, last])
    bones = joints[:, [upper, middle, last]]
    pole = turned[:, upper, :, pole_axis] if pole_axis is not None else bones[:, 1] - bones[:, [0, 2]].mean(axis=1)
    _, bent = two_bone(bones, turned[:, [upper, middle]], target, pole, soft=1e-3)
    out = rotations.copy()
    out[:, upper] = _undone(turned[:, SMPL24.parents[upper]]) @ bent[:, 0]
    out[:, middle] = _undone(bent[:, 0]) @ bent[:, 1]
    out[:, last] = _undone(bent[:, 1]) @ turned[:, last]
    return out


def places(rotations: Values, root: Values) -> tuple[Values, Values]:
    """Global joints ``(F, 24, 3)`` and rotations ``(F, 24, 3, 3)``."""
    joints, turned = fk(rotations, root, SMPL24.offsets.astype(np.float64), SMPL24.parents)
    return joints.astype(np.float64), turned.astype(np.float64)


def _undone(rotations: Array) -> Array:
    return np.swapaxes(rotations, -1, -2)
