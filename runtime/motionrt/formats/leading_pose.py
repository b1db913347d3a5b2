"""The calibration pose that many motion files carry before their first real frame."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.arguments import check_kind

_LATEST_JUMP = 4
"""The jump away from the pose is looked for in so many steps: blank frames may stand before the motion."""

_LONGEST_LEAD = 6
"""Smoothed conversions blend from the pose to the motion over several frames; at most so many are dropped."""

_LATER_STEPS = 8
_JUMP_RATIO = 4.0
_BLEND_RATIO = 2.5
_BLEND_SHARE = 1 / 20
_DISTANCE = np.deg2rad(15.0)
_NEARLY_ZERO = np.deg2rad(8.0)
_MOVES = np.deg2rad(0.5)


def drop_leading_tpose(clip: RigClip) -> tuple[RigClip, FloatArray | None]:
    """Split a leading calibration pose from the motion.

    Frame 0 is taken for a calibration pose if nearly all joints have (nearly) no rotation in it, and the clip
    jumps away from it at once: by far more than in the frames that follow. A clip that starts in a T-pose and
    moves smoothly, and a clip of one frame, stay whole. Blank or half-blended frames between the pose and the
    motion, which the CMU conversions have, go as well.

    Returns:
        The clip without those frames, and frame 0 as a reference pose: local rotations ``(J, 3, 3)``.
        ``(clip, None)`` if there is nothing to drop.
    """
    check_kind(clip, RigClip, "clip", "a RigClip")
    joints = [j for j, name in enumerate(clip.names) if not name.endswith("_end")]
    lead = _lead(clip.rotations[: _LONGEST_LEAD + _LATER_STEPS + 1, joints])
    if lead == 0:
        return clip, None
    return clip.slice(lead), clip.rotations[0].copy()


def _lead(rotations: FloatArray) -> int:
    """Number of leading frames to drop, from the first frames ``(F, J, 3, 3)``."""
    moves = (_angle(rotations[:1], rotations) > _MOVES).any(axis=0)
    if len(rotations) < 4 or not moves.any() or not _is_rest(rotations[0], moves):
        return 0
    steps = _angle(rotations[:-1, moves], rotations[1:, moves]).mean(axis=-1)
    jump = int(steps[: min(_LATEST_JUMP, len(steps) - 1)].argmax())
    if steps[jump] < _JUMP_RATIO * _usual(steps, jump):
        return 0
    lead = jump + 1
    while lead < min(_LONGEST_LEAD, len(steps) - 1) and steps[lead] > _still_blending(steps, lead, jump):
        lead += 1
    distance = _angle(rotations[0, moves], rotations[lead, moves]).mean()
    return lead if distance > _DISTANCE else 0


def _is_rest(pose: FloatArray, moves: npt.NDArray[np.bool_]) -> bool:
    """Whether a pose ``(J, 3, 3)`` is nearly free of rotation, also among the joints that move later."""
    zero = _angle(pose, np.eye(3)) < _NEARLY_ZERO
    return bool(zero.mean() > 0.7 and zero[moves].mean() > 0.4)


def _usual(steps: npt.NDArray[np.float64], k: int) -> float:
    """The size of the steps after step ``k``."""
    return float(np.median(steps[k + 1 : k + 1 + _LATER_STEPS]))


def _still_blending(steps: npt.NDArray[np.float64], k: int, jump: int) -> float:
    return max(_BLEND_RATIO * _usual(steps, k), _BLEND_SHARE * float(steps[jump]))


def _angle(a: npt.ArrayLike, b: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Angle in radians between rotations ``(..., 3, 3)``."""
    trace = (np.asarray(a, dtype=np.float64) * np.asarray(b)).sum(axis=(-2, -1))
    return np.asarray(np.arccos(np.clip((trace - 1) / 2, -1, 1)))
