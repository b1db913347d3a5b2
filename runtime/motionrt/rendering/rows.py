"""A row of a filmstrip: which poses, seen from where, and how much room they take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.motion import Motion
from motionrt.motion.transforms import heading
from motionrt.rendering.body import SOLE
from motionrt.rendering.camera import Camera, looking
from motionrt.rendering.framing import CROWN, FLESH, first_heading
from motionrt.rendering.look import Look
from motionrt.rendering.poses import Poses, side_by_side
from motionrt.rendering.solids import Floats
from motionrt.rendering.takes import Take

FLOOR_DEPTH = 0.7  # metres of floor before and behind the feet
_DISTANCE = 9.0  # metres
_CLOSEST, _FARTHEST, _GAP = 0.55, 1.5, 0.04  # metres between poses
_EDGE = 0.3


@dataclass
class Row:
    """A motion in a strip; lengths in metres on the paper.

    Attributes:
        take: what is shown.
        poses: frames and words.
        cameras: of each pose; they look at the place on the floor below the pelvis.
        apart: between two poses.
        left: before the first pose.
        right: after the last one.
        top: highest that is drawn above the floor.
        below: lowest that is drawn, below the floor.
    """

    take: Take
    poses: Poses
    cameras: list[Camera]
    apart: float
    left: float
    right: float
    top: float
    below: float

    @property
    def width(self) -> float:
        """Metres."""
        return self.left + (len(self.cameras) - 1) * self.apart + self.right

    def spread(self, width: float) -> None:
        """Let the poses take all of a width, as far as that looks well."""
        free = (width - self.width) / max(len(self.cameras) - 1, 1)
        self.apart = min(self.apart + max(free, 0.0), max(_FARTHEST, self.apart))


def row_of(take: Take, look: Look) -> Row:
    """The row, with its poses as close to each other as they can stand."""
    poses = side_by_side(take, look)
    cameras = _cameras(take, look, poses)
    outlines = [take.outline(frame) for frame in poses.frames.tolist()]
    left, right, top, bottom = np.array([_reach(*pair) for pair in zip(cameras, outlines, strict=True)]).T
    wanted = float((right[:-1] - left[1:]).max(initial=0.0)) + _GAP
    floor = FLOOR_DEPTH * abs(float(cameras[0].turn[2][1])) + SOLE
    return Row(
        take,
        poses,
        cameras,
        apart=float(np.clip(wanted, _CLOSEST, _FARTHEST)),
        left=_EDGE + max(0.0, -float(left[0])),
        right=_EDGE + max(0.0, float(right[-1])),
        top=max(_tall(take.motion), float(top.max())) + 0.04,
        below=max(floor, -float(bottom.min())) + 0.03,
    )


def _cameras(take: Take, look: Look, poses: Poses) -> list[Camera]:
    """One for each pose: all see the world from one side, or each sees the character from one side."""
    motion = take.motion
    yaw = np.full(motion.frames, first_heading(motion))
    if look.follow:
        try:
            yaw = np.asarray(heading(motion), np.float64)
        except InvalidInputError:  # a skeleton without hips faces nowhere
            yaw = yaw * 1.0
    feet = feet_of(take)
    return [looking(look.view, float(yaw[f]), look.elevation, feet[f], _DISTANCE) for f in poses.frames]


def feet_of(take: Take) -> Floats:
    """``(F, 3)`` the places on the floor below the pelvis."""
    feet = take.motion.root.copy()
    feet[:, 1] = take.ground
    return feet


def _tall(motion: Motion) -> float:
    """Metres of room above the floor at least, so that rows of standing figures are alike."""
    return 1.04 * float(np.ptp(motion.skeleton.rest_positions[:, 1])) + FLESH


def _reach(camera: Camera, joints: Floats) -> tuple[float, float, float, float]:
    """Left, right, top and bottom of a pose, metres on the paper, y up."""
    x, y, _ = camera.project(joints)[0].T
    return float(x.min() - FLESH), float(x.max() + FLESH), float(CROWN - y.min()), float(-y.max() - SOLE)
