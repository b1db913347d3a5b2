"""Walks along other paths: a recording bent along its way, its feet held where they stand.

The trajectory turns by so many radians per metre walked; every frame turns with it. A planted foot would then slide
about the pelvis, so its contacts are locked again.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation


def bent(motion: Motion, curvature: Array) -> Motion:
    """Turned along its way by ``curvature`` (F,) rad/m, before any locking of feet."""
    planar = motion.root * np.array([1, 0, 1], dtype=np.float32)
    steps = np.diff(smoothed(planar), axis=0, prepend=smoothed(planar)[:1])
    yaw = np.cumsum(np.asarray(curvature) * np.linalg.norm(steps, axis=1))
    turn = axis_rotation("Y", yaw).astype(np.float32)  # (F, 3, 3)
    moves = np.diff(planar, axis=0, prepend=planar[:1])
    root = planar[0] + np.cumsum((turn @ moves[..., None])[..., 0], axis=0)
    rotations = motion.rotations.copy()
    rotations[:, 0] = turn @ rotations[:, 0]
    return replace(motion, rotations=rotations, root=root + motion.root * np.array([0, 1, 0], dtype=np.float32))


def wave(frames: int, rng: np.random.Generator, strongest: float, period: float = 90.0) -> Array:
    """A smooth random curvature (F,) within ``strongest`` rad/m: interpolated cosines, about ``period`` frames long."""
    knots = max(2, int(np.ceil(frames / period * 2)) + 2)
    heights = rng.uniform(-strongest, strongest, knots)
    at = np.linspace(0.0, knots - 1.0, frames)
    low = np.minimum(at.astype(int), knots - 2)
    part = 0.5 - 0.5 * np.cos(np.pi * (at - low))
    return heights[low] * (1 - part) + heights[low + 1] * part


def smoothed(track: Array, window: int = 15) -> Array:
    """Moving average of ``(F, D)`` over ``window`` (odd) frames, ends repeated."""
    padded = np.pad(track, ((window // 2, window // 2), (0, 0)), mode="edge")
    sums = np.cumsum(np.concatenate([np.zeros_like(padded[:1], dtype=np.float64), padded]), axis=0)
    return (sums[window:] - sums[:-window]) / window
