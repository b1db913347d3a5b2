"""Walkers of a crowd keep out of each other's way: who is about to meet somebody passes on the right, and slower."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.crowd import SPEED
from motionrt.motion.rotations import Array, wrapped

REACH = 2.5  # metres within which others are minded
AHEAD = 1.2  # radians to either side of the way within which somebody is ahead
PASSES = 1.0  # radians that the way turns for somebody straight ahead and near
SLOWER = 0.6  # of the speed, for somebody who nearly touches
CLOSE = 0.7  # metres at which two nearly touch
LED = 1.5  # metres to the place that a walker is led to meanwhile

Values = npt.NDArray[np.float64]


def around_others(places: Array, goals: Array, speeds: float | Array = SPEED) -> tuple[Values, Values]:
    """Goals and speeds for :meth:`Crowd.step` with which walkers pass each other.

        goals, speeds = around_others(crowd.positions, targets)
        crowd.step(goals, speeds)

    Args:
        places: ``(B, 2)`` x and z of every walker, metres.
        goals: ``(B, 3)`` x, z and heading of where each wants to go.
        speeds: m/s that each wants, one for all or ``(B,)``.

    Returns:
        Goals ``(B, 3)`` and speeds ``(B,)``; those of walkers with nobody ahead are as they were.

    Raises:
        InvalidInputError: arrays of other shapes, or numbers that are not finite.
    """
    here, aims = np.asarray(places, dtype=np.float64), np.asarray(goals, dtype=np.float64)
    count = len(here)
    if (
        here.shape != (count, 2)
        or aims.shape != (count, 3)
        or not (np.isfinite(here).all() and np.isfinite(aims).all())
    ):
        raise InvalidInputError(f"give finite places (B, 2) and goals (B, 3), not {here.shape} and {aims.shape}")
    pace = np.broadcast_to(np.asarray(speeds, dtype=np.float64), (count,)).copy()
    way = np.arctan2(*(aims[:, :2] - here).T)
    off, away = _seen(here, way)
    minded = (away < REACH) & (np.abs(off) < AHEAD)
    weight = np.where(minded, (1 - away / REACH) * (1 - np.abs(off) / AHEAD), 0.0)
    turn = -PASSES * np.sqrt(weight.max(axis=1, initial=0.0))  # negative is to the right
    near = np.where(minded, np.clip((REACH - away) / (REACH - CLOSE), 0, 1), 0.0).max(axis=1, initial=0.0)
    led = here + LED * np.stack([np.sin(way + turn), np.cos(way + turn)], axis=1)
    apart = np.hypot(*(aims[:, :2] - here).T)
    changed = (turn < -1e-3) & (apart > CLOSE)
    out = np.where(changed[:, None], np.column_stack([led, way + turn]), aims)
    return out, np.where(changed, pace * (1 - (1 - SLOWER) * near), pace)


def _seen(here: Values, way: Values) -> tuple[Values, Values]:
    """``(B, B)`` radians by which each sees the others off its way, and metres between them; itself infinitely far."""
    apart = here[None] - here[:, None]
    away = np.hypot(apart[..., 0], apart[..., 1])
    np.fill_diagonal(away, np.inf)
    return np.asarray(wrapped(np.arctan2(apart[..., 0], apart[..., 1]) - way[:, None])), away
