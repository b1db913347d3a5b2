"""Forearms keep out of the surfaces of a scene: they are moved away as far as they are inside, and only while they are.

Nets that fill a transition know nothing of tables. What hangs or swings into something is moved out by the arm's
inverse kinematics; hands that hold something stay where they hold it. Legs and trunk are left as they are: poses are
solved clear of surfaces, and paths keep their distance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.held_points import Hold, held_weight, places, reaching
from motionrt.metrics.penetration import THICKNESS, Surfaces
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.lock import smooth_cover

ROUNDS = 4
REACH = 1.5  # metres from the pelvis beyond which no arm reaches
FARTHEST = 0.25  # metres that a wrist is moved
HALF = 6  # frames to either side over which a correction comes and goes
_SHARES = np.linspace(0.2, 1.0, 6)  # of the way from the elbow to the wrist
_SKIN = THICKNESS["forearm"]

Values = npt.NDArray[np.float64]


def in_reach(motion: Motion, surfaces: npt.ArrayLike) -> Values:
    """Of points ``(N, 3)`` those that a hand of ``motion`` could come near to: pieces of planes cost much to find."""
    from scipy.spatial import cKDTree

    points = np.asarray(surfaces, dtype=np.float64)
    away, _ = cKDTree(motion.root).query(points, distance_upper_bound=REACH)
    return np.asarray(points[np.isfinite(away)])


def clear_forearms(motion: Motion, surfaces: Surfaces, holds: Sequence[Hold]) -> Motion:
    """The motion with its forearms outside the surfaces.

    Args:
        motion: on ``smpl24``, in the world.
        surfaces: of everything but the ground.
        holds: first frame, the one behind the last, and {joint: (x, y, z) metres} of each held pose, see
            :func:`motionrt.locomotion.held_points.hold_points`.
    """
    rotations, root = motion.rotations.astype(np.float64), motion.root.astype(np.float64)
    for side in ("left", "right"):
        chain = tuple(SMPL24.index(f"{side}_{name}") for name in ("shoulder", "elbow", "wrist"))
        free = 1.0 - _held(motion.frames, side, holds)
        for _ in range(ROUNDS):
            joints = places(rotations, root)[0]
            push = _push(joints[:, chain[1]], joints[:, chain[2]], surfaces)
            if not push.any():
                break
            aim = joints[:, chain[2]] + free[:, None] * _smoothed(push)
            rotations = reaching(rotations, root, (*chain, chain[2]), aim, pole_axis=None)
    return replace(motion, rotations=rotations.astype(np.float32))


def _held(frames: int, side: str, holds: Sequence[Hold]) -> Values:
    """``(F,)`` 1 while the arm of a side holds something, fading around it."""
    out = np.zeros(frames)
    for start, end, points in holds:
        if any(name in points for name in (f"{side}_hand", f"{side}_wrist", f"{side}_elbow")):
            out = np.maximum(out, held_weight(np.arange(frames), start, end))
    return out


def _push(elbows: Values, wrists: Values, surfaces: Surfaces) -> Values:
    """``(F, 3)`` metres that wrists have to move so that the deepest place of each forearm comes out."""
    along = elbows[:, None] + _SHARES[:, None] * (wrists - elbows)[:, None]
    away, ways = surfaces.away(along.reshape(-1, 3), _SKIN)
    depth = np.maximum(_SKIN - away, 0.0).reshape(along.shape[:2])
    deepest = (np.arange(len(depth)), depth.argmax(axis=1))
    moved = (depth[deepest] / _SHARES[deepest[1]])[:, None] * ways.reshape(along.shape)[deepest]
    return np.asarray(moved * np.minimum(1.0, FARTHEST / np.maximum(np.linalg.norm(moved, axis=1), 1e-9))[:, None])


def _smoothed(push: Values) -> Values:
    """The same as a curve that comes and goes gently and is nowhere shorter."""
    kernel = np.hanning(2 * HALF + 3)[1:-1]
    padded = np.pad(push, ((HALF, HALF), (0, 0)), mode="edge")
    around = np.stack([np.convolve(column, kernel, mode="valid") for column in padded.T], axis=1)
    ways = around / np.maximum(np.linalg.norm(around, axis=1, keepdims=True), 1e-9)
    return np.asarray(ways * smooth_cover(np.linalg.norm(push, axis=1), HALF)[:, None])
