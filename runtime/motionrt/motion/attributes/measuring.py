"""``Attributes``: what a clip does, in numbers, and ``measure``, which finds them."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import limbs, paths, postures
from motionrt.motion.attributes.body import Body
from motionrt.motion.attributes.postures import POSTURES
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import FloatArray

_SIGNED = frozenset({"turn", "travel_left", "walk_left", "path_bend", "arm_dominance", "leg_dominance"})


@dataclass(frozen=True)
class Attributes:
    """What a clip does. Metres, seconds, degrees; left is positive; the first pose's frame unless said otherwise.

    Attributes:
        seconds: first frame to last.
        turn: net turn of the body, degrees.
        spin_extent: widest range of headings, degrees.
        travel_forward, travel_left: from the first pelvis position to the last, in the first pose's frame, m.
        walk_forward, walk_left: the same summed up along the way in the frame of the moment, m.
        path_length: length of the smoothed path of the pelvis over the ground, m.
        farthest: greatest distance from the start, m.
        speed_mean, speed_max: of the pelvis over the ground, m/s; the maximum over half a second.
        path_bend: how far the path bends, degrees; path_radius: its mean radius, m (1000 when straight).
        left_hand_over_shoulder, right_hand_over_shoulder: greatest height of the wrist over its shoulder, m.
        left_hand_over_head, right_hand_over_head: the same over the head joint, m.
        left_hand_up_share, right_hand_up_share: share of the time above the shoulder, 0 to 1.
        both_hands_over_shoulder: greatest height that both wrists have at once, m.
        lowest_hand: lowest height of a wrist above the floor, m.
        hands_apart: least distance of the hands, m; hands_together_share: share of the time below 0.22 m.
        claps: how often the hands meet and part.
        left_foot_lift, right_foot_lift: greatest height of the ankle over the lower one's ground, m.
        steps: how often a foot is lifted and put down.
        left_hand_speed, right_hand_speed, left_foot_speed, right_foot_speed: mean speed about shoulder or hip, m/s.
        left_hand_peak, right_hand_peak, left_foot_peak, right_foot_peak: greatest speed, m/s.
        torso_speed: mean speed of the neck about the pelvis, m/s.
        arm_dominance, leg_dominance: which side moves more, -1 (only the right) to 1 (only the left).
        stillness: share of the time in which nothing moves faster than 0.2 m/s.
        repetitions: periods of a repeated movement, 0 where none shows.
        posture_start, posture_end, posture_lowest, posture_most: numbers of ``POSTURES``.
        pelvis_start, pelvis_end, pelvis_lowest: height of the pelvis, 1 when standing.
        lean_max, lean_mean: forward lean of the trunk, degrees.
        upside_down_share: share of the time, 0 to 1.
        jumps: how often both feet leave the floor, running excepted; jump_height: m.
    """

    seconds: float
    turn: float
    spin_extent: float
    travel_forward: float
    travel_left: float
    walk_forward: float
    walk_left: float
    path_length: float
    farthest: float
    speed_mean: float
    speed_max: float
    path_bend: float
    path_radius: float
    left_hand_over_shoulder: float
    right_hand_over_shoulder: float
    left_hand_over_head: float
    right_hand_over_head: float
    left_hand_up_share: float
    right_hand_up_share: float
    both_hands_over_shoulder: float
    lowest_hand: float
    hands_apart: float
    hands_together_share: float
    claps: float
    left_foot_lift: float
    right_foot_lift: float
    steps: float
    left_hand_speed: float
    right_hand_speed: float
    left_foot_speed: float
    right_foot_speed: float
    left_hand_peak: float
    right_hand_peak: float
    left_foot_peak: float
    right_foot_peak: float
    torso_speed: float
    arm_dominance: float
    leg_dominance: float
    stillness: float
    repetitions: float
    posture_start: float
    posture_end: float
    posture_lowest: float
    posture_most: float
    pelvis_start: float
    pelvis_end: float
    pelvis_lowest: float
    lean_max: float
    lean_mean: float
    upside_down_share: float
    jumps: float
    jump_height: float

    @property
    def in_place(self) -> bool:
        """Whether it stays within half a metre of where it starts."""
        return self.farthest < 0.5

    @property
    def posture_names(self) -> tuple[str, str, str]:
        """Posture at the start, at the end and at the lowest, in words."""
        start, end, lowest = (POSTURES[int(n)] for n in (self.posture_start, self.posture_end, self.posture_lowest))
        return start, end, lowest

    def row(self) -> FloatArray:
        """``(A,)`` float32, in the order of :data:`ATTRIBUTES`."""
        return np.array([getattr(self, name) for name in ATTRIBUTES], dtype=np.float32)

    @classmethod
    def from_row(cls, row: npt.ArrayLike) -> Attributes:
        """The inverse of :meth:`row`."""
        return cls(*np.asarray(row, dtype=np.float64).tolist())

    def mirrored(self) -> Attributes:
        """What the mirror image of the clip does."""
        return Attributes(**{name: self._of_mirror(name) for name in ATTRIBUTES})

    def _of_mirror(self, name: str) -> float:
        for side, other in (("left_", "right_"), ("right_", "left_")):
            if name.startswith(side):
                return float(getattr(self, other + name.removeprefix(side)))
        return float(getattr(self, name)) * (-1.0 if name in _SIGNED else 1.0)


ATTRIBUTES = tuple(field.name for field in fields(Attributes))
"""Names of the numbers, in the order of a row."""


def measure(motion: Motion | npt.ArrayLike, fps: float | None = None) -> Attributes:
    """What a clip does: of a :class:`Motion`, or of joint positions ``(F, 24, 3)`` in metres, Y up, with their ``fps``.

    Raises:
        InvalidInputError: another shape, numbers that are not finite, or no frame rate beside positions.
    """
    positions, rate = (motion.positions(), motion.fps) if isinstance(motion, Motion) else (motion, fps or 0.0)
    body = Body.of(positions, rate)
    parts = (paths.turning, paths.travelling, limbs.hands, limbs.feet, limbs.moving, limbs.repetition)
    found = {name: value for part in (*parts, postures.postures, postures.jumps) for name, value in part(body).items()}
    return Attributes(seconds=body.seconds, **found)
