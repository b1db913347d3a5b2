"""Whoever stays on the spot is carried by the feet that stand: the root goes so that they do not slide."""

from __future__ import annotations

import numpy as np

from motionrt.models.text import FloatArray
from motionrt.motion.features import ego77
from motionrt.synthesis.smoothing import smoothed
from motionrt.text import TextAttributes

ON_THE_SPOT, GOING = 1.0, 0.3  # how far the root is carried; whoever goes a way goes it, if need be on feet that slide
_SPREAD = 0.03  # metres above a standing height over which a foot counts less and less


def share_of(said: TextAttributes) -> float:
    """How far the feet carry the root of a motion: 1 wholly, 0 not at all."""
    if said.jumps:
        return 0.0
    if said.path not in (None, "straight", "spin"):
        return 0.0
    return ON_THE_SPOT if said.travel in (None, "none") else GOING


def carried(features: FloatArray, share: float) -> FloatArray:
    """Features ``(F, 77)`` whose root goes, by a share of 0 to 1, as the feet in contact want it."""
    rows = np.asarray(features, np.float64)
    feet = rows[:, ego77.JOINTS].reshape(len(rows), -1, 3)[:, [joint - 1 for joint in ego77.FEET]]
    x, z = ego77.to_body(feet[1:, :, 0], feet[1:, :, 2], -rows[:-1, :1])
    wanted = feet[:-1][..., [0, 2]] - np.stack([x, z], axis=-1)  # the way that keeps each of them where it is
    above = np.maximum(feet[:-1, :, 1] - ego77.LOW, 0)
    stands = np.clip(rows[:-1, ego77.CONTACTS], 0, 1) ** 2 * np.exp(-above / _SPREAD)
    total = stands.sum(axis=1, keepdims=True)
    mean = (stands[..., None] * wanted).sum(axis=1) / np.maximum(total, 1e-6)
    part = share * np.clip(total, 0, 1)
    ways = (1 - part) * rows[:-1, 1:3] + part * mean
    found = np.array(features, np.float32)
    found[:, 1:3] = smoothed(np.concatenate([ways, ways[-1:]]).astype(np.float32))
    return found
