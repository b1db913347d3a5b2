"""Limbs do what a text says: who stands still is still, one arm waves where one is named, and punches reach out."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.text import TextAttributes, gestures_of_text

STILL = 0.1  # m/s that hands and feet of whoever stands still may have
ONE_ARM = 0.55  # speed of the other hand beside that of the one that a text names, at most
LEAST = 0.15  # part of a motion that is left at least
THRUSTS = frozenset({"punch", "throw"})  # acts in which an arm is stretched, as it is in recordings of them
STRETCHED = 0.97  # of the length of an arm
LARGEST = 3.0  # times as far that a thrust is made, at most
SMALLEST = 0.02  # metres of a thrust that is worth it
_FASTER, _SHORT = 1.01, 1e-3  # times too fast and metres too short that are let be, so that no rounding decides

BoolArray = npt.NDArray[np.bool_]


def calmed(features: FloatArray, said: TextAttributes) -> tuple[FloatArray, BoolArray]:
    """Features ``(F, 77)`` with less motion where the text wants little, and ``(F, 6)`` which parts were changed."""
    rows, parts = np.array(features, np.float32), np.zeros((len(features), len(PARTS)), bool)
    if len(rows) < 2:
        return rows, parts
    if said.still:
        speed = max(_speed(rows, f"{side}_{joint}") for side in ("left", "right") for joint in ("wrist", "ankle"))
        if speed > _FASTER * STILL:
            part = max(LEAST, STILL / speed)
            _scaled(rows, np.arange(ego77.CONTACTS.start), part)
            rows[:, :3] *= part
            parts[:] = True
        return rows, parts
    side = _hand_of(said)
    if side is not None:
        _favour(rows, parts, side)
    if said.action in THRUSTS:
        for side in ("left", "right"):
            if said.arm in (None, "both", side) and _thrust(rows, side):
                parts[:, PARTS.index(f"{side} arm")] = True
    return rows, parts


def _hand_of(said: TextAttributes) -> str | None:
    """The one hand that does what a text says."""
    if said.arm in ("left", "right"):
        return said.arm
    hands = [side for side, _ in gestures_of_text(said).hands] if said.arm is None else []
    return hands[0] if len(hands) == 1 else None


def _thrust(rows: FloatArray, side: str) -> bool:
    """Stretch an arm where it reaches out farthest; in place. Whether anything had to be done."""
    shoulder, elbow, wrist, hand = (_columns(f"{side}_{joint}") for joint in ("shoulder", "elbow", "wrist", "hand"))
    upper, lower = (float(np.linalg.norm(SMPL24.offsets[SMPL24.index(f"{side}_{end}")])) for end in ("elbow", "wrist"))
    full = STRETCHED * (upper + lower)
    away = rows[:, wrist] - rows[:, shoulder]
    reach = np.maximum(np.linalg.norm(away, axis=1), 1e-3)
    usual, farthest = float(np.median(reach)), float(reach.max())
    if farthest > full - _SHORT or farthest - usual < SMALLEST:
        return False
    times = min(LARGEST, (full - usual) / (farthest - usual))
    farther = np.where(reach > usual, usual + times * (reach - usual), reach)
    straight = np.clip((farther - reach) / (full - reach), 0, 1)[:, None]
    moved = away * (farther / reach)[:, None]
    along = rows[:, shoulder] + moved * (upper / (upper + lower))
    rows[:, elbow] += (straight * (along - rows[:, elbow])).astype(np.float32)
    rows[:, wrist] += (moved - away).astype(np.float32)
    rows[:, hand] += (moved - away).astype(np.float32)
    return True


def _favour(rows: FloatArray, parts: BoolArray, side: str) -> None:
    """Calm the other arm where it moves as much as the one that is named; in place."""
    other = "right" if side == "left" else "left"
    named, left_out = (_speed(rows, f"{one}_wrist", f"{one}_shoulder") for one in (side, other))
    if left_out <= _FASTER * ONE_ARM * named:
        return
    _about_shoulder(rows, other, max(LEAST, ONE_ARM * named / left_out))
    parts[:, PARTS.index(f"{other} arm")] = True


def _about_shoulder(rows: FloatArray, side: str, part: float) -> None:
    """Scale how an arm moves about its shoulder; in place."""
    arm = np.concatenate([_columns(f"{side}_{joint}") for joint in ("elbow", "wrist", "hand")])
    base = np.tile(rows[:, _columns(f"{side}_shoulder")], len(arm) // 3)
    rows[:, arm] -= base
    _scaled(rows, arm, part)
    rows[:, arm] += base


def _scaled(rows: FloatArray, columns: npt.NDArray[np.intp], part: float) -> None:
    """Scale how far columns are from their means over time; in place."""
    mean = rows[:, columns].mean(axis=0)
    rows[:, columns] = mean + part * (rows[:, columns] - mean)


def _speed(rows: FloatArray, joint: str, about: str | None = None) -> float:
    """Mean speed of a joint in the axes of the body, or about another joint, m/s."""
    place = rows[:, _columns(joint)] - (rows[:, _columns(about)] if about else 0)
    return float(np.linalg.norm(np.diff(place, axis=0), axis=1).mean() * ego77.FPS)


def _columns(joint: str) -> npt.NDArray[np.intp]:
    first = ego77.column(SMPL24.index(joint))
    return np.arange(first, first + 3)
