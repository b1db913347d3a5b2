"""A recording brought onto flat ground: its standing feet at y = 0 all the way, not only its lowest toe.

:meth:`Motion.grounded` moves a whole motion by one number, the lowest toe of all. A toe that dips once leaves every
other step centimetres in the air, and a capture volume that is not level makes a walk climb. Here the ground is what
the standing feet say it is, step by step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.motion.feet.contacts import STRICT_SPEED, speeds
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.runs import BoolArray
from motionrt.motion.transforms import TOE_JOINTS, floor_height

HIGHEST = 0.15  # metres above the lowest toe: what stands higher stands on something
SMOOTH_S = 0.8  # standard deviation in seconds of the average over time: about the time of a step
LOW, UPRIGHT = 0.2, 0.4  # heights of the pelvis in metres between which the ground of feet counts more and more
QUANTILE = 0.3  # of the heights of standing toes: late in a step the toe joint rises with the heel


def flat_ground(motion: Motion) -> Motion:
    """Moved vertically, slowly varying over time, so that the toes of standing feet lie at y = 0.

    Jumps keep their height, and so do feet on stools and steps: the ground is interpolated between standing feet near
    the lowest one. Without any, this is :meth:`Motion.grounded`.
    """
    lift = np.zeros((motion.frames, 3), dtype=np.float32)
    lift[:, 1] = ground_curve(motion)
    return replace(motion, root=motion.root - lift)


def upright_ground(motion: Motion) -> Motion:
    """A ``smpl24`` motion on flat ground while somebody is on the feet or knees; who lies keeps the height."""
    pelvis = motion.positions()[:, motion.skeleton.index("pelvis"), 1]
    share = np.clip((pelvis - LOW) / (UPRIGHT - LOW), 0, 1)
    lift = np.zeros((motion.frames, 3), dtype=np.float32)
    lift[:, 1] = ground_curve(motion) * share
    return replace(motion, root=motion.root - lift)


def ground_curve(motion: Motion) -> Array:
    """``(F,)`` metres: height of the toe joint of a standing foot over time."""
    toes = motion.positions()[:, [motion.skeleton.index(name) for name in TOE_JOINTS]]
    lowest = floor_height(motion)
    stands = (speeds(toes, motion.fps) < STRICT_SPEED) & (toes[..., 1] < lowest + HIGHEST)
    known: BoolArray = stands[:, 0] | stands[:, 1]
    if not known.any():
        return np.full(motion.frames, lowest)
    height = np.where(stands, toes[..., 1], np.inf).min(axis=1)
    level = float(np.quantile(height[known], QUANTILE))
    return _smoothed(height, known, level, SMOOTH_S * motion.fps)


def _smoothed(height: Array, known: BoolArray, level: float, spread: float) -> Array:
    """Gaussian average over the known frames, leaning on ``level`` where there are few."""
    reach = int(np.ceil(3 * spread))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / spread) ** 2)
    weight = np.convolve(known.astype(float), bell)[reach:-reach]
    total = np.convolve(np.where(known, height - level, 0), bell)[reach:-reach]
    return np.asarray(level + total / (weight + 0.1 * spread))
