"""Feet on slopes and stairs: each foot stands on the ground under itself, pitched as that is, and swings over edges.

A character walks on a plane and is raised to the ground under its pelvis (:mod:`motionrt.locomotion.terrain`). Its feet
are elsewhere: ahead, behind, on another step. Here every foot that stands is put onto its own ground and stays there;
between two stands it goes from one height to the other, above everything that lies between; the pelvis sinks where a
leg would be too short.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.footfalls import eased
from motionrt.locomotion.terrain import Heights
from motionrt.motion import Motion
from motionrt.motion.feet.contacts import stretches
from motionrt.motion.feet.lock import with_feet_moved
from motionrt.motion.feet.two_bone import LEG_JOINTS
from motionrt.motion.rotations import axis_angle_to_matrix

EVEN = 0.004  # metres between the ground under the feet and under the pelvis: less is flat
STEEPEST = np.tan(np.radians(35.0))  # a foot pitches up to this; what is steeper is an edge, and stood on level
CLEARS = 0.02  # metres that a swinging foot keeps above the ground
HIGHEST_ARC = 0.3  # metres that a swing is raised for that, at most
EARLY = 0.4  # of an arc: edges that come earlier are not cleared in full
SINKS, HALF = 0.25, 5  # metres that the pelvis may sink, and half the frames over which it does
SHIFTS = tuple(sign * 0.02 * k for k in range(1, 9) for sign in (1.0, -1.0))  # metres to look for a tread
TIP = 0.07  # metres of the toes beyond their joint
_ANKLES, _TOES = ([leg[i] for leg in LEG_JOINTS] for i in (2, 3))

Values = npt.NDArray[np.float64]
Under = Callable[[Values], Values]
"""Places ``(N, 2)`` (x, z) -> ``(N,)`` metres of the ground, NaN where there is none."""


def feet_on_ground(motion: Motion, planted: npt.NDArray[np.bool_], ground: Heights, under: Under) -> Motion:
    """The motion with its feet on the ground.

    Args:
        motion: on ``smpl24``, raised to ``ground``.
        planted: ``(F, 2)`` when the left and the right foot stand.
        ground: ``(F,)`` metres that the motion was raised by.
        under: the heights of the ground.

    Returns:
        The same frames; those of flat ground unchanged.
    """
    joints, turned = motion.positions().astype(np.float64), motion.global_rotations().astype(np.float64)
    ankles, toes = joints[:, _ANKLES], joints[:, _TOES]
    soles = _soles(ankles, toes, under, ground)
    if np.abs(soles - ground[:, None, None]).max() < EVEN:
        return motion
    level = toes[..., 1] - ground[:, None]
    courses = [
        _course(planted[:, foot], ankles[:, foot], toes[:, foot], soles[:, foot], level[:, foot], under)
        for foot in (0, 1)
    ]
    rise, pitch = (np.stack([course[:, i] for course in courses], axis=1) for i in (0, 1))
    bones, tilt = toes - ankles, _tilts(toes - ankles, pitch)
    offset = bones - np.einsum("fkij,fkj->fki", tilt, bones)
    offset[..., 1] += rise + level - toes[..., 1]
    offset[..., [0, 2]] += np.stack([course[:, 2:] for course in courses], axis=1)
    turned[:, _ANKLES] = tilt @ turned[:, _ANKLES]
    return with_feet_moved(motion, joints, turned, offset, np.ones_like(planted), max_drop=SINKS, half=HALF)


def surface_gaps(motion: Motion, planted: npt.NDArray[np.bool_], under: Under) -> Values:
    """``(N,)`` metres between each standing foot's ball and the ground under it; negative where it is below.

    Where there is no ground nothing is measured.
    """
    toes = motion.positions()[:, _TOES].astype(np.float64)[planted]
    gaps = toes[:, 1] - under(toes[:, [0, 2]])
    return np.asarray(gaps[np.isfinite(gaps)])


def _soles(ankles: Values, toes: Values, under: Under, ground: Heights) -> Values:
    """``(F, 2, 3)`` heights of the ground under heel, ball and tip of each foot."""
    places = _places(ankles, toes)
    found = under(places.reshape(-1, 2)).reshape(places.shape[:-1])
    return np.where(np.isfinite(found), found, ground[:, None, None])


def _places(ankles: Values, toes: Values) -> Values:
    """``(..., 3, 2)`` where heel, ball and tip of feet ``(..., 3)`` are over the ground."""
    way = (toes - ankles)[..., [0, 2]]
    tips = toes[..., [0, 2]] + TIP * way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-6)
    return np.stack([ankles[..., [0, 2]], toes[..., [0, 2]], tips], axis=-2)


def _course(
    planted: npt.NDArray[np.bool_], ankles: Values, toes: Values, soles: Values, level: Values, under: Under
) -> Values:
    """``(F, 4)`` of one foot: height of the ground that it is on, pitch (radians, heel up), metres moved along x, z."""
    course, runs = np.zeros((len(soles), 4)), stretches(planted)
    course[:, 0] = soles[:, 1]
    for start, end in runs:
        course[start:end] = _stand(
            np.median(_places(ankles[start:end], toes[start:end]), axis=0), soles[start:end], under
        )
    for start, end in stretches(~planted) if runs else []:
        if start == 0 or end == len(planted):
            course[start:end] = course[end if start == 0 else start - 1]
            continue
        now = (np.arange(start, end) - start + 1) / (end - start + 1)
        before, behind = course[start - 1], course[end]
        course[start:end] = before + eased(now)[:, None] * (behind - before)
        arc = np.sin(np.pi * now)
        missing = soles[start:end].max(axis=1) + CLEARS - (course[start:end, 0] + level[start:end])
        needed = float((np.maximum(missing, 0.0) * (arc > EARLY) / np.maximum(arc, EARLY)).max())
        course[start:end, 0] += min(needed, HIGHEST_ARC) * arc
    return course


def _stand(places: Values, soles: Values, under: Under) -> tuple[float, float, float, float]:
    """Height, pitch and shift (x, z) of a foot that stands at places ``(3, 2)``; off the edge of a step, if it can."""
    heel, ball, tip = np.median(soles, axis=0)
    length = max(float(np.linalg.norm(places[1] - places[0])), 1e-3)
    ahead = (places[1] - places[0]) / length
    if _slopes(heel, ball, tip, length):
        return float(ball), float(np.arctan2(heel - ball, length)), 0.0, 0.0
    for far in SHIFTS:
        moved = under(places + far * ahead)
        if np.isfinite(moved).all() and _slopes(float(moved[0]), float(moved[1]), float(moved[2]), length):
            pitch = float(np.arctan2(moved[0] - moved[1], length))
            return float(moved[1]), pitch, float(far * ahead[0]), float(far * ahead[1])
    return float(max(heel, ball, tip)), 0.0, 0.0, 0.0


def _slopes(heel: float, ball: float, tip: float, length: float) -> bool:
    """Whether heel, ball and tip are on one slope, and on no edge."""
    return bool(abs(heel - ball) <= STEEPEST * length and abs(ball - tip) <= STEEPEST * TIP)


def _tilts(bones: Values, pitch: Values) -> Values:
    """``(F, 2, 3, 3)`` turns about each foot's own left, heel up."""
    ahead = bones * np.array([1.0, 0.0, 1.0])
    ahead /= np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-9)
    left = np.stack([ahead[..., 2], np.zeros_like(pitch), -ahead[..., 0]], axis=-1)
    return np.asarray(axis_angle_to_matrix(left * pitch[..., None]))
