"""Feet that slide along the floor through a long contact take steps instead.

A foot that is low and slow but travels further than a lock may pin it is set down at places along its way, lifted from
one to the next in turn with the other foot. Where it is when, in the mean, stays as it was.
"""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.feet.contacts import LOOSE_SPEED, STRICT_HEIGHT, STRICT_SPEED, speeds
from motionrt.motion.feet.lock import BLEND_S, MAX_DROP, MAX_SHIFT, faded, with_feet_moved
from motionrt.motion.feet.two_bone import LEG_JOINTS
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.runs import BoolArray, Runs
from motionrt.motion.skeleton import SMPL24

STRAYS = 0.1  # metres that a foot may be off the place where it stands before it is lifted
SWING_S, REST_S = 0.3, 0.13  # seconds that a foot is in the air, and stands at least
LIFT = 0.05  # metres
WALKS, SHORTEST_S, LEAP_S = (0.3, 2.2), 0.1, 0.25  # m/s of a pelvis; how long neither foot stands, and around a leap
UPRIGHT = 0.6  # metres that the pelvis is high: who crawls or kneels drags the feet
_TOES = [leg[3] for leg in LEG_JOINTS]
_PELVIS = SMPL24.index("pelvis")


def step_where_sliding(motion: Motion, floor: float = 0.0, *, walking: bool = False) -> Motion:
    """``motion`` with steps in place of slides; a motion whose feet stand or swing is returned as it is.

    Only legs and pelvis height change. Feet keep their global rotations. The feet are to be locked afterwards.

    Args:
        motion: a ``smpl24`` motion on the floor (:meth:`Motion.grounded`), any frame rate.
        floor: height in metres of the toe joint of a standing foot.
        walking: steps as well where somebody walks and neither foot stands, however fast they slide.

    Raises:
        InvalidInputError: another skeleton.
    """
    if motion.skeleton != SMPL24:
        raise InvalidInputError("step_where_sliding needs a motion of the smpl24 skeleton")
    positions = motion.positions().astype(np.float64)
    toes = positions[:, _TOES]
    sliding = _sliding(toes, positions[:, _PELVIS], motion.fps, floor, walking)
    if not sliding.any():
        return motion
    offset = _stepped(toes, sliding, motion.fps, floor)
    offset = np.ascontiguousarray(_tails(offset, sliding, BLEND_S * motion.fps))
    half = max(1, round(BLEND_S * motion.fps / 2))
    return with_feet_moved(motion, positions, motion.global_rotations(), offset, sliding, max_drop=MAX_DROP, half=half)


def _sliding(toes: Array, pelvis: Array, fps: float, floor: float, walking: bool) -> BoolArray:
    """``(F, 2)``: when a toe of somebody upright travels along the floor too far to be pinned."""
    low = (toes[..., 1] - floor < STRICT_HEIGHT) & (speeds(toes, fps) < LOOSE_SPEED)
    if walking:
        low |= _neither(toes, pelvis, fps, floor)[:, None]
    low &= (pelvis[:, 1] > floor + UPRIGHT)[:, None]
    runs = Runs.of(low)
    inside = runs.flat(toes)[runs.inside][:, [0, 2]]
    spread = runs.reduce(np.maximum, inside) - runs.reduce(np.minimum, inside)
    return runs.flags(np.hypot(*spread.T) > 2 * MAX_SHIFT)


def _neither(toes: Array, pelvis: Array, fps: float, floor: float) -> BoolArray:
    """``(F,)``: when somebody who walks has neither foot standing, and does not leap."""
    height, flat = toes[..., 1] - floor, np.array([1.0, 0.0, 1.0])
    speed, way = speeds(toes * flat, fps), speeds(pelvis[:, None] * flat, fps)[:, 0]
    reach = round(LEAP_S * fps)
    high = (height.min(axis=1) > STRICT_HEIGHT).astype(float)
    leaps = np.convolve(high, np.ones(2 * reach + 1))[reach : reach + len(high)] > 0.5
    found = (height.min(axis=1) < STRICT_HEIGHT) & (speed.min(axis=1) > STRICT_SPEED)
    runs = Runs.of((found & (way > WALKS[0]) & (way < WALKS[1]) & ~leaps)[:, None])
    return runs.flags(runs.lengths >= round(SHORTEST_S * fps))[:, 0]


def _stepped(toes: Array, sliding: BoolArray, fps: float, floor: float) -> Array:
    """``(F, 2, 3)``: what moves each toe from where it slides to where it stands or swings; 0 elsewhere."""
    swing, rest = max(3, round(SWING_S * fps)), max(2, round(REST_S * fps))
    offset = np.zeros_like(toes)
    place = [toes[0, foot].copy() for foot in (0, 1)]
    left = [-rest, -rest]  # frames at which the feet landed
    aloft: list[tuple[int, Array, Array] | None] = [None, None]
    for frame in range(len(toes)):
        for foot in (0, 1):
            now = toes[frame, foot]
            if not sliding[frame, foot]:
                aloft[foot], left[foot] = None, frame
                continue
            if frame == 0 or not sliding[frame - 1, foot]:
                place[foot] = _stand(toes[:, foot], sliding[:, foot], frame)
            flight = aloft[foot]
            off = float(np.hypot(*(now - place[foot])[[0, 2]]))
            if flight is None and off > STRAYS and aloft[1 - foot] is None and frame - left[foot] >= rest:
                landing = min(frame + swing, len(toes) - 1)
                flight = aloft[foot] = (frame, place[foot], _stand(toes[:, foot], sliding[:, foot], landing))
            if flight is None:
                offset[frame, foot] = place[foot] - now
                offset[frame, foot, 1] = -max(now[1] - floor, 0.0)
                continue
            began, start, end = flight
            s = min(1.0, (frame - began) / swing)
            offset[frame, foot] = start + s * s * (3 - 2 * s) * (end - start) - now
            offset[frame, foot, 1] = LIFT * np.sin(np.pi * s) - max(now[1] - floor, 0.0)
            if s >= 1:
                place[foot], aloft[foot], left[foot] = end, None, frame
    return offset


def _stand(way: Array, sliding: BoolArray, frame: int) -> Array:
    """Where a foot that lands at a frame stands: as far ahead on its way as it may stray."""
    ahead = way[frame:]
    stops = np.flatnonzero(~sliding[frame:])
    ahead = ahead[: max(1, stops[0] if len(stops) else len(ahead))]
    far = np.flatnonzero(np.hypot(*(ahead - ahead[0])[:, [0, 2]].T) >= STRAYS)
    return np.asarray(ahead[far[0] if len(far) else -1])


def _tails(offset: Array, sliding: BoolArray, blend: float) -> Array:
    runs = Runs.of(~sliding)
    return np.asarray(runs.shaped(faded(runs.flat(offset), runs, blend)))
