"""A walk whose contacts are known, because its feet are put where they are by the law of cosines."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion

PERIOD_S, DUTY = 1.0, 0.6
SOLE, HEIGHT = 0.065, 0.90  # ankle of a flat foot, and pelvis, above the floor, metres
_HIP = np.array([0.085, -0.075])
_THIGH, _SHIN = 0.405, float(np.hypot(0.410, 0.010))


def gait(
    seconds: float = 4.0, fps: float = 30.0, speed: float = 0.6, slide: float = 0.0, lift: float = 0.08
) -> tuple[Motion, np.ndarray]:
    """Flat-footed walk along +Z and its contacts ``(F, 2)``.

    All of it, feet too, slides sideways at ``slide`` m/s; swinging feet rise by ``lift`` metres.
    """
    time = np.arange(round(seconds * fps)) / fps
    rotations = np.tile(np.eye(3), (len(time), 24, 1, 1))
    root = np.stack([slide * time, np.full_like(time, HEIGHT), speed * time], axis=1)
    contacts = np.zeros((len(time), 2), dtype=bool)
    for side, (name, shift) in enumerate((("left", 0.0), ("right", 0.5))):
        phase = time / PERIOD_S + shift
        swing = np.clip((phase % 1 - DUTY) / (1 - DUTY), 0, 1)
        contacts[:, side] = phase % 1 < DUTY
        progress = swing**2 * (3 - 2 * swing)
        ahead = speed * PERIOD_S * (np.floor(phase) + progress - shift + DUTY / 2) - root[:, 2]
        down = HEIGHT + _HIP[1] - SOLE - lift * np.sin(np.pi * swing) ** 2
        for joint, angle in zip(("hip", "knee", "ankle"), _leg(ahead, down), strict=True):
            rotations[:, SMPL24.index(f"{name}_{joint}")] = Rotation.from_rotvec(np.outer(angle, [1, 0, 0])).as_matrix()
    return Motion(rotations.astype(np.float32), root.astype(np.float32), fps), contacts


def _leg(ahead: np.ndarray, down: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Turns about X of hip, knee and ankle that put a level foot ``ahead`` of and ``down`` from the hip."""
    reach = np.hypot(ahead, down)
    at_hip = np.arccos((_THIGH**2 + reach**2 - _SHIN**2) / (2 * _THIGH * reach))
    at_knee = np.pi - np.arccos((_THIGH**2 + _SHIN**2 - reach**2) / (2 * _THIGH * _SHIN))
    hip = -np.arctan2(ahead, down) - at_hip
    knee = at_knee - np.arctan2(0.010, 0.410)
    return hip, knee, -hip - knee
