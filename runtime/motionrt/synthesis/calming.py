"""Limbs that a text leaves out are calmed: who stands still is still, who waves with one arm waves with that one."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.text import TextAttributes

STILL = 0.1  # m/s that hands and feet of whoever stands still may have
ONE_ARM = 0.55  # speed of the other hand beside that of the one that a text names, at most
LEAST = 0.15  # part of a motion that is left at least

BoolArray = npt.NDArray[np.bool_]


def calmed(features: FloatArray, said: TextAttributes) -> tuple[FloatArray, BoolArray]:
    """Features ``(F, 77)`` with less motion where the text wants little, and ``(F, 6)`` which parts were changed."""
    rows, parts = np.array(features, np.float32), np.zeros((len(features), len(PARTS)), bool)
    if len(rows) < 2:
        return rows, parts
    if said.still:
        speed = max(_speed(rows, f"{side}_{joint}") for side in ("left", "right") for joint in ("wrist", "ankle"))
        if speed > STILL:
            _less(rows, np.arange(ego77.WIDTH - 4), max(LEAST, STILL / speed))
            rows[:, :3] *= max(LEAST, STILL / speed)
            parts[:] = True
    elif said.arm in ("left", "right"):
        _favour(rows, parts, said.arm)
    return rows, parts


def _favour(rows: FloatArray, parts: BoolArray, side: str) -> None:
    """Calm the other arm where it moves as much as the one that is named; in place."""
    other = "right" if side == "left" else "left"
    named, left_out = (_speed(rows, f"{one}_wrist", f"{one}_shoulder") for one in (side, other))
    if left_out <= ONE_ARM * named:
        return
    shoulder = _columns(f"{other}_shoulder")
    arm = np.concatenate([_columns(f"{other}_{joint}") for joint in ("elbow", "wrist", "hand")])
    base = np.tile(rows[:, shoulder], len(arm) // 3)
    rows[:, arm] -= base
    _less(rows, arm, max(LEAST, ONE_ARM * named / left_out))
    rows[:, arm] += base
    parts[:, PARTS.index(f"{other} arm")] = True


def _less(rows: FloatArray, columns: npt.NDArray[np.intp], part: float) -> None:
    """Bring columns nearer to their means over time; in place."""
    mean = rows[:, columns].mean(axis=0)
    rows[:, columns] = mean + part * (rows[:, columns] - mean)


def _speed(rows: FloatArray, joint: str, about: str | None = None) -> float:
    """Mean speed of a joint in the axes of the body, or about another joint, m/s."""
    place = rows[:, _columns(joint)] - (rows[:, _columns(about)] if about else 0)
    return float(np.linalg.norm(np.diff(place, axis=0), axis=1).mean() * ego77.FPS)


def _columns(joint: str) -> npt.NDArray[np.intp]:
    first = ego77.JOINTS.start + 3 * (SMPL24.index(joint) - 1)
    return np.arange(first, first + 3)
