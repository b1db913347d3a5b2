"""A standing pose and a stride to begin with: those that come with motionrt, or stand-ins for them.

``_assets/stride.npz`` packs two motions (:class:`motionrt.formats.motion_pack.MotionPack`): a steady walk of at least a
second, and one frame of standing.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from motionrt.locomotion.crowd import FPS, SPEED
from motionrt.locomotion.goal_frame import Goal, canonicalise
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.transforms import grounded, heading

if TYPE_CHECKING:
    from motionrt.locomotion.posing.body import Prior

STRIDE_FILE = Path(__file__).parents[1] / "_assets" / "stride.npz"
STANDING = {
    "pelvis": (0.0, 0.955, 0.0),
    "left_foot": (0.10, 0.0, 0.11),
    "right_foot": (-0.10, 0.0, 0.11),
    "left_wrist": (0.25, 0.86, 0.03),
    "right_wrist": (-0.25, 0.86, 0.03),
    "head": (0.0, 1.555, 0.03),
}
_SWINGS = {"hip": 0.42, "shoulder": -0.35}  # radians, of the left side


def stride() -> Motion:
    """Frames of a steady walk at 30 fps; the last one above the origin, heading +Z."""
    packed = _packed()
    return stride_of(packed[0]) if packed else stride_of(plain_stride())


def standing() -> Motion | None:
    """One frame above the origin, facing +Z; None where none comes with motionrt."""
    packed = _packed()
    return stride_of(packed[1][-1:]) if len(packed) > 1 else None


def solved_standing(prior: Prior) -> Motion:
    """A standing pose from the pose prior."""
    from motionrt.locomotion.posing import solve_pose

    return stride_of(solve_pose(STANDING, prior, heading=0.0).motion)


def stride_of(motion: Motion) -> Motion:
    """A motion moved so that its last frame is above the origin, heading +Z."""
    x, _, z = motion.root[-1]
    return canonicalise(motion, Goal(float(x), float(z), float(heading(motion[-1:])[0])))


def plain_stride(seconds: float = 2.0) -> Motion:
    """A walk of pendulums, where no better one is to be had."""
    time = np.arange(round(seconds * FPS)) / FPS
    swing = np.sin(2 * np.pi * time)
    rotations = np.tile(np.eye(3), (len(time), len(SMPL24), 1, 1))
    for side, sign, arm in (("left", 1.0, -1.3), ("right", -1.0, 1.3)):
        hip, shoulder = (sign * _SWINGS[joint] * swing for joint in ("hip", "shoulder"))
        knee = 0.9 * np.maximum(0, np.sin(2 * np.pi * time + (0.3 if sign > 0 else 0.3 + np.pi))) ** 2
        rotations[:, SMPL24.index(f"{side}_hip")] = axis_rotation("X", -hip)
        rotations[:, SMPL24.index(f"{side}_knee")] = axis_rotation("X", knee)
        hang = axis_rotation("X", -shoulder) @ axis_rotation("Z", np.array(arm))
        rotations[:, SMPL24.index(f"{side}_shoulder")] = hang
    root = np.stack([np.zeros_like(time), np.full_like(time, 0.95), SPEED * time], axis=1)
    return grounded(Motion(rotations.astype(np.float32), root.astype(np.float32), FPS))


def _packed() -> tuple[Motion, ...]:
    from motionrt.formats.motion_pack import MotionPack

    if not STRIDE_FILE.is_file():
        return ()
    pack = MotionPack.read(STRIDE_FILE)
    return tuple(pack[i] for i in range(len(pack)))
