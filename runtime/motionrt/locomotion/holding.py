"""Held poses that are alive: the chest breathes and the head looks about a little, the feet stay where they are."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.rotations import axis_angle_to_matrix

BREATH_S = 3.6  # seconds of a breath
EASE_S = 0.8  # seconds over which the movement sets in and fades, so that a hold begins and ends in its pose
_SWING = {"spine2": 0.006, "spine3": 0.009, "neck": 0.012, "head": 0.016}  # radians


def hold(pose: Motion, seconds: float, seed: int = 0) -> Motion:
    """``pose``, one frame, held for ``seconds``; the same for the same seed. At least one frame.

    A hand at arm's length moves by less than a centimetre.

    Raises:
        InvalidInputError: more than one frame, or no time.
    """
    if pose.frames != 1 or not (np.isfinite(seconds) and seconds >= 0):
        raise InvalidInputError(f"hold one frame for some seconds, not {pose.frames} for {seconds}")
    count = max(1, round(seconds * pose.fps))
    time = np.arange(1, count + 1) / pose.fps
    ease = np.clip(np.minimum(time, (count + 1) / pose.fps - time) / EASE_S, 0, 1)
    ease = ease * ease * (3 - 2 * ease)
    rotations = np.repeat(pose.rotations, count, axis=0)
    random = np.random.default_rng(seed)
    for name, swing in _SWING.items():
        joint = pose.skeleton.index(name)
        turn = axis_angle_to_matrix(_sway(time, random) * (swing * ease)[:, None]).astype(np.float32)
        rotations[:, joint] = rotations[:, joint] @ turn
    return Motion(rotations, np.repeat(pose.root, count, axis=0), pose.fps, pose.skeleton)


def _sway(time: npt.NDArray[np.float64], random: np.random.Generator) -> npt.NDArray[np.float64]:
    """Rotation vectors ``(F, 3)`` of about unit length: a breath about X, slower wandering about the other axes."""
    phase = random.uniform(0, 2 * np.pi, 3)
    slow = BREATH_S * random.uniform(1.6, 2.6, 2)
    periods = np.array([BREATH_S, *slow])
    return np.asarray(np.sin(2 * np.pi * time[:, None] / periods + phase) * np.array([1.0, 0.7, 0.4]))
