"""Motions in time: read at other moments, stretched, held, and looped for as long as it takes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation
from motionrt.motion.skeleton import FloatArray
from motionrt.motion.transforms import heading
from motionrt.synthesis.composing.blending import blended

FADE_S = 0.25  # seconds over which a looped motion passes from its end into its start


def warped(motion: Motion, times: Array) -> Motion:
    """``motion`` read at ``times`` ``(N,)`` in frames, 0 .. F - 1: slerp between frames, whole frames bit for bit."""
    before = np.clip(np.floor(times).astype(int), 0, motion.frames - 1)
    after = np.minimum(before + 1, motion.frames - 1)
    weight = np.clip(times - before, 0, 1)
    weight[weight < 1e-6] = 0
    turned, whole = motion.rotations[before], weight == 0
    turned[~whole] = blended(turned[~whole], motion.rotations[after[~whole]], weight[~whole][:, None])
    root = motion.root[before] + weight[:, None] * (motion.root[after] - motion.root[before])
    return replace(motion, rotations=turned, root=root)


def stretched(motion: Motion, frames: int) -> Motion:
    """Slower or faster, so that it plays from its first to its last frame in ``frames`` frames."""
    return warped(motion, np.linspace(0, motion.frames - 1, frames))


def held(pose: Motion, frames: int) -> Motion:
    """A motion of one frame as long as ``frames``."""
    return warped(pose, np.zeros(frames))


def looped(motion: Motion, frames: int) -> Motion:
    """``frames`` frames of ``motion``: its beginning if it is longer, else repeated from where it is like its start.

    Every round starts where the one before has led, heading on from there, and passes into it over a quarter of a
    second (a third of the motion where that is shorter). The first round is the motion's own, bit for bit.
    """
    if motion.frames >= frames:
        return motion[:frames]
    if motion.frames == 1:
        return held(motion, frames)
    fade = max(1, min(round(FADE_S * motion.fps), motion.frames // 3))
    end = _like_the_start(motion, fade)
    turn, step = _advance(motion, end)
    cycle = _cycle(motion, end, fade, turn, step)
    rotations, roots, offset = [motion.rotations[:end]], [motion.root[:end]], step
    for number in range(1, -(-frames // end)):
        yaw = axis_rotation("Y", np.float64(number * turn))
        rotations.append(_pelvis_turned(cycle.rotations, yaw))
        roots.append((cycle.root @ yaw.T + offset).astype(np.float32))
        offset = offset + yaw @ step
    return replace(motion, rotations=np.concatenate(rotations)[:frames], root=np.concatenate(roots)[:frames])


def _like_the_start(motion: Motion, fade: int) -> int:
    """The frame of the second half whose pose and what follows is most like the first ``fade`` frames."""
    ends = np.arange(motion.frames // 2, motion.frames - fade + 1)
    pose = motion.rotations[:, 1:].reshape(motion.frames, -1)
    late = np.linalg.norm(pose[ends + fade - 1] - pose[fade - 1], axis=-1)
    height = np.abs(motion.root[ends, 1] - motion.root[0, 1])
    return int(ends[np.argmin(np.linalg.norm(pose[ends] - pose[0], axis=-1) + late + height)])


def _advance(motion: Motion, end: int) -> tuple[float, Array]:
    """The turn about Y (radians) and then the move over the ground that lead from frame 0 to frame ``end``."""
    headings = heading(motion)
    turn = float(headings[end] - headings[0])
    step = motion.root[end].astype(np.float64) - axis_rotation("Y", np.float64(turn)) @ motion.root[0]
    return turn, step * np.array([1, 0, 1])


def _cycle(motion: Motion, end: int, fade: int, turn: float, step: Array) -> Motion:
    """One round where the motion stands at first, its first ``fade`` frames coming out of the round before."""
    back = axis_rotation("Y", np.float64(-turn))
    weight = (np.arange(fade) + 1) / (fade + 1)
    weight = weight**2 * (3 - 2 * weight)
    leaving = _pelvis_turned(motion.rotations[end : end + fade], back)
    rotations, root = motion.rotations[:end].copy(), motion.root[:end].copy()
    rotations[:fade] = blended(leaving, rotations[:fade], weight[:, None])
    left = (motion.root[end : end + fade] - step) @ back.T
    root[:fade] = left + weight[:, None] * (root[:fade] - left)
    return replace(motion, rotations=rotations, root=root)


def _pelvis_turned(rotations: FloatArray, turn: Array) -> FloatArray:
    out = rotations.copy()
    out[:, 0] = turn @ out[:, 0]
    return out
