"""Compositions of two recordings for the generator: the arms of one on the body of another (SINC 3.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24

Joints = NDArray[np.floating]

SIDES = ("left", "right")
ALONE = 2.5  # times as fast as the other hand: that arm acts alone
CALM = 0.35  # m/s of a foot in the body's axes up to which nothing but the arms acts
_ARM = ("elbow", "wrist", "hand")


def acting_arms(joints: Joints) -> tuple[str, ...]:
    """The arms that do what is done in ``(F, 24, 3)``; none where legs or the whole body do it, too."""
    own = ego77.encode(joints)[:, ego77.JOINTS].reshape(len(joints), -1, 3)
    speeds = np.linalg.norm(np.diff(own, axis=0), axis=-1).mean(0) * ego77.FPS
    left, right, *feet = (
        float(speeds[SMPL24.index(name) - 1]) for name in ("left_wrist", "right_wrist", "left_foot", "right_foot")
    )
    if max(feet) > CALM or max(left, right) < 2 * max(feet):
        return ()
    if max(left, right) > ALONE * min(left, right):
        return ("left",) if left > right else ("right",)
    return SIDES


def with_arms(body: Joints, donor: Joints, arms: tuple[str, ...]) -> NDArray[np.float64]:
    """``body`` ``(F, 24, 3)`` with arms of ``donor`` ``(F, 24, 3)``, kept as they hang on its line of the shoulders.

    Bones keep the lengths of the donor.
    """
    made = np.array(body, np.float64)
    turn = _heading(made) - _heading(donor)
    cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
    for side in arms:
        shoulder = SMPL24.index(f"{side}_shoulder")
        joints = [SMPL24.index(f"{side}_{name}") for name in _ARM]
        away = np.asarray(donor[:, joints], np.float64) - donor[:, [shoulder]]
        x, z = away[..., 0], away[..., 2]
        turned = np.stack([x * cos + z * sin, away[..., 1], z * cos - x * sin], axis=-1)
        made[:, joints] = made[:, [shoulder]] + turned
    return made


def _heading(joints: Joints) -> NDArray[np.float64]:
    """``(F,)`` heading of the line of the shoulders, radians, left positive."""
    across = joints[:, SMPL24.index("left_shoulder")] - joints[:, SMPL24.index("right_shoulder")]
    return np.asarray(np.arctan2(-across[:, 2], across[:, 0]), np.float64)
