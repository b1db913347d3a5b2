"""Heads that look, nod and shake, which joint positions cannot say: their turns are added to the drawn motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from motionrt.motion import Motion
from motionrt.motion.rotations import axis_angle_to_matrix
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.timeline import Line
from motionrt.text import gestures_of_text, parse_query

RAMP_S = 0.4  # seconds over which a head begins and ends
_JOINTS = [SMPL24.index("neck"), SMPL24.index("head")]


def with_heads(motion: Motion, lines: Sequence[Line]) -> Motion:
    """A ``smpl24`` motion whose head does what its texts say of it, half in the neck; itself where they say nothing."""
    times = np.arange(motion.frames) / motion.fps
    turns = np.zeros((motion.frames, 3))
    for line in lines:
        head = gestures_of_text(parse_query(line.text)).head
        if head is None:
            continue
        weight = np.clip(np.minimum(times - line.start, line.end - times) / RAMP_S, 0, 1)
        swing = np.sin(2 * np.pi * head.hz * (times - line.start)) if head.hz else 1.0
        turns[:, :2] += (weight * swing)[:, None] * (head.down, head.left)
    if not turns.any():
        return motion
    half = axis_angle_to_matrix(turns / 2)
    rotations = motion.rotations.copy()
    for joint in _JOINTS:
        rotations[:, joint] = half @ rotations[:, joint]
    return replace(motion, rotations=rotations.astype(np.float32))
