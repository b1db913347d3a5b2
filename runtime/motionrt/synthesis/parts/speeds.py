"""`velocity_parts`: which parts move in a motion, by speed alone (the baseline of SINC 3.1 and its Table 1)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import ARMS, LEGS, PART_JOINTS, PARTS
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import wrapped
from motionrt.motion.transforms import heading

# Chosen on the labels of the 560 CMU training segments. The torso's speed tells next to nothing about its label (the
# sway of a walk is as fast as a bow): it is set like the limbs, so that it does not count with every walk. A nod of
# the head alone is slower still and takes torso=0.2.
LIMB_SPEED = 0.5  # m/s, joints of arms and legs as seen from where the limb is attached
TORSO_SPEED = 0.5  # m/s, joints of the trunk as seen from the pelvis
ROOT_SPEED = 0.20  # m/s
TURN_RATE = 1.0  # rad/s
PUBLISHED_SHARE = 0.65  # of the way from the slowest to the fastest part, as SINC has it
_FRAME = {**dict.fromkeys(ARMS, "spine3"), **dict.fromkeys(LEGS, "pelvis"), "torso": "pelvis"}


def velocity_parts(
    motion: Motion,
    threshold: float = LIMB_SPEED,
    *,
    torso: float = TORSO_SPEED,
    root: float = ROOT_SPEED,
    turning: float = TURN_RATE,
) -> frozenset[str]:
    """The parts that move: arms as seen from the chest, legs and torso as seen from the pelvis, global by the root.

    A part moves when its :func:`part_speeds` exceed the threshold.

    Args:
        motion: any motion of ``smpl24``.
        threshold: of arms and legs, m/s.
        torso: of the trunk, m/s.
        root: of the pelvis in the world, m/s.
        turning: of the heading, rad/s; either of the two makes it ``global``.

    Raises:
        InvalidInputError: another skeleton, or a threshold that is negative or not a number.
    """
    limits = {**dict.fromkeys((*ARMS, *LEGS), threshold), "torso": torso, "global": root, "turning": turning}
    if not all(np.isfinite(limit) and limit >= 0 for limit in limits.values()):
        raise InvalidInputError("the thresholds of velocity_parts must be numbers >= 0, in m/s and rad/s")
    speeds = part_speeds(motion)
    moving = {name for name, limit in limits.items() if speeds[name] > limit}
    return frozenset({"global" if name == "turning" else name for name in moving})


def relative_velocity_parts(motion: Motion, threshold: float = PUBLISHED_SHARE) -> frozenset[str]:
    """The baseline as SINC published it: the parts that are fast beside the others, whatever their speed.

    The speed of a part is that of the mean of its joints in the world, averaged over the frames; the slowest of the six
    parts counts 0, the fastest 1, and a part moves above ``threshold``. Nothing moves where all are alike.

    Raises:
        InvalidInputError: another skeleton, or a threshold that is not from 0 to 1.
    """
    if not 0 <= threshold <= 1:
        raise InvalidInputError(f"the threshold of relative_velocity_parts is a share from 0 to 1, not {threshold}")
    _check_joints(motion)
    steps = np.diff(motion.positions(), axis=0)
    speeds = {part: float(np.linalg.norm(steps[:, list(PART_JOINTS[part])].mean(1), axis=-1).mean()) for part in PARTS}
    slowest, fastest = min(speeds.values()), max(speeds.values())
    if len(steps) == 0 or fastest <= slowest:
        return frozenset()
    return frozenset(part for part, speed in speeds.items() if (speed - slowest) / (fastest - slowest) > threshold)


def _check_joints(motion: Motion) -> None:
    if any(max(joints) >= len(motion.skeleton) for joints in PART_JOINTS.values()):
        raise InvalidInputError("velocity_parts needs a motion of smpl24; see motionrt.rigs.retarget_in")


def part_speeds(motion: Motion) -> Mapping[str, float]:
    """How fast each part moves: of the joint that moves most, the root mean square speed over the motion.

    Returns:
        m/s for each of :data:`motionrt.motion.body_parts.PARTS`, and ``turning`` in rad/s. All zero for one frame.
    """
    _check_joints(motion)
    speeds = {part: _fastest(_seen_from(motion, part, _FRAME[part]), motion.fps) for part in PARTS if part in _FRAME}
    speeds["global"] = _fastest(motion.root[:, None], motion.fps)
    turns = wrapped(np.diff(heading(motion))) * motion.fps
    speeds["turning"] = float(np.sqrt(np.mean(turns**2))) if turns.size else 0.0
    return speeds


def _seen_from(motion: Motion, part: str, frame: str) -> np.ndarray:
    """Positions ``(F, joints, 3)`` of a part in the frame of a joint, metres."""
    origin = motion.skeleton.index(frame)
    offsets = motion.positions()[:, list(PART_JOINTS[part])] - motion.positions()[:, origin, None]
    return np.asarray(np.swapaxes(motion.global_rotations()[:, origin, None], -1, -2) @ offsets[..., None])[..., 0]


def _fastest(positions: np.ndarray, fps: float) -> float:
    """Root mean square speed of the joint that moves most, m/s, of ``(F, joints, 3)``."""
    if len(positions) < 2:
        return 0.0
    speed = np.linalg.norm(np.diff(positions, axis=0), axis=-1) * fps
    return float(np.sqrt(np.mean(speed**2, axis=0)).max())
