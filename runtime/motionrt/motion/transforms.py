"""Whole-motion transforms: resampling, mirroring, canonical facing, grounding.

They take and return a :class:`motionrt.Motion`, whose methods most of them are.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.limits import how_to_raise, limits
from motionrt.motion.batches import by_batches
from motionrt.motion.checks import checked_fps
from motionrt.motion.frames import Frames
from motionrt.motion.rotations import (
    Array,
    axis_rotation,
    matrix_to_quaternion,
    quaternion_to_matrix,
    slerp,
    yaw_angle,
)
from motionrt.motion.skeleton import FloatArray

Clip = TypeVar("Clip", bound=Frames)

TOE_JOINTS = ("left_foot", "right_foot")
_ACROSS_JOINTS = (("left_hip", "right_hip"), ("left_shoulder", "right_shoulder"))
_CALM_S = 0.5  # half the length of the mean that a way over the ground is, seconds
_MIRROR = np.diag([-1.0, 1.0, 1.0]).astype(np.float32)


def facing(motion: Frames) -> Array:
    """Unit heading of the body in the ground plane, ``(F, 3)``: across hips and shoulders, crossed with up."""
    positions, index = motion.positions(), motion.skeleton.index
    pairs = [(index(left), index(right)) for left, right in _ACROSS_JOINTS]
    across = np.sum([positions[:, left] - positions[:, right] for left, right in pairs], axis=0)
    forward = np.stack([-across[:, 2], np.zeros(motion.frames), across[:, 0]], axis=-1)  # left x up
    length = np.linalg.norm(forward, axis=-1, keepdims=True)
    return np.where(length < 1e-8, [0, 0, 1], forward / np.maximum(length, 1e-8)).astype(np.float32)


def heading(motion: Frames) -> Array:
    """Yaw of :func:`facing`, ``(F,)`` radians from +Z towards +X."""
    return yaw_angle(facing(motion))


def resample(motion: Clip, fps: float) -> Clip:
    """``motion`` at ``fps`` frames per second; frame 0 stays frame 0, times beyond the last frame are not invented."""
    fps = checked_fps(fps)
    if abs(fps - motion.fps) < 1e-9:
        return motion
    count = int(np.floor((motion.frames - 1) * fps / motion.fps + 1e-6)) + 1
    if count > limits().frames:
        raise InvalidInputError(f"{count:,} frames at {fps:g} fps are too many: {how_to_raise('frames')}")
    times = np.arange(count) * (motion.fps / fps)
    before = np.minimum(times.astype(int), motion.frames - 1)
    after = np.minimum(before + 1, motion.frames - 1)
    weight = (times - before).astype(np.float32)
    root = by_batches(lambda *rows: _beside(motion.root, *rows), before, after, weight)
    if weight.max(initial=0) > 1e-6:  # between frames: spherical interpolation; otherwise frames are just picked
        quaternions = by_batches(matrix_to_quaternion, motion.rotations)
        rotations = by_batches(lambda *rows: _between(quaternions, *rows), before, after, weight)
    else:
        rotations = by_batches(lambda rows: motion.rotations[rows], before)
    return replace(motion, rotations=rotations, root=root, fps=fps)


def _beside(places: FloatArray, before: Array, after: Array, weight: Array) -> FloatArray:
    """Places between those of two rows of frames."""
    return np.asarray(places[before] * (1 - weight[:, None]) + places[after] * weight[:, None], dtype=np.float32)


def _between(quaternions: Array, before: Array, after: Array, weight: Array) -> FloatArray:
    """Rotations between those of two rows of frames."""
    found = slerp(quaternions[before], quaternions[after], weight[:, None])
    return quaternion_to_matrix(found).astype(np.float32)


def mirror(motion: Clip) -> Clip:
    """Reflect about x = 0: ``R' = M R M`` of the opposite joint, with ``M = diag(-1, 1, 1)``."""
    partners = list(motion.skeleton.mirrored_joints)
    rotations = by_batches(lambda rows: _MIRROR @ rows[:, partners] @ _MIRROR, motion.rotations)
    return replace(motion, rotations=rotations, root=motion.root @ _MIRROR)


def turned(motion: Clip, yaw: float) -> Clip:
    """Turn about the vertical axis through the world's origin by ``yaw`` radians."""
    turn = axis_rotation("Y", np.float32(yaw)).astype(np.float32)

    def turned_part(rotations: FloatArray) -> FloatArray:
        out = rotations.copy()
        out[:, 0] = turn @ out[:, 0]
        return out

    rotations = by_batches(turned_part, motion.rotations)
    return replace(motion, rotations=rotations, root=by_batches(lambda part: part @ turn.T, motion.root))


def moved(motion: Clip, offset: Array) -> Clip:
    """Translate by ``offset`` ``(3,)`` metres."""
    way: FloatArray = np.asarray(offset, dtype=np.float32)
    return replace(motion, root=motion.root + way).posed_as(motion, way)


def canonical(motion: Clip) -> Clip:
    """Frame 0 above the origin and facing +Z; heights stay."""
    upright = turned(motion, -float(heading(motion[:1])[0]))
    return moved(upright, -upright.root[0] * np.array([1, 0, 1], dtype=np.float32))


def in_place(motion: Clip) -> Clip:
    """Without its way over the ground, the smoothed path of the pelvis; sway about it, heights and turns stay."""
    path = motion.root[:, [0, 2]].astype(np.float64)
    half = min(max(1, round(_CALM_S * motion.fps)), motion.frames - 1)
    if half > 0:
        before, after = 2 * path[:1] - path[half:0:-1], 2 * path[-1:] - path[-2 : -half - 2 : -1]
        summed = np.cumsum(np.concatenate([np.zeros((1, 2)), before, path, after]), axis=0)
        path = (summed[2 * half + 1 :] - summed[: -2 * half - 1]) / (2 * half + 1)
    root = motion.root.copy()
    root[:, [0, 2]] -= path.astype(np.float32)
    return replace(motion, root=root)


def floor_height(motion: Frames) -> float:
    """Height in metres of the floor under ``motion``: the 1st percentile over frames of its lower toe joint."""
    toes = [motion.skeleton.index(name) for name in TOE_JOINTS]
    return float(np.percentile(motion.positions()[:, toes, 1].min(axis=1), 1.0))


def grounded(motion: Clip) -> Clip:
    """Moved vertically so that the floor of the motion (:func:`floor_height`) lies at y = 0."""
    return moved(motion, np.array([0, -floor_height(motion), 0], dtype=np.float32))
