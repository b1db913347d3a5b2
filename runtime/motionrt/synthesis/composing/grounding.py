"""Legs under a pelvis that is not theirs: its height follows the feet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from motionrt.motion.feet.two_bone import LEG_JOINTS
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.transforms import TOE_JOINTS
from motionrt.synthesis.composing.ownership import Weights

_LEGS = [joint for leg in LEG_JOINTS for joint in leg]


def on_their_ground(motion: Motion, layers: Sequence[Motion], weights: Weights) -> Motion:
    """``motion`` with its lower toe as high as the lower toe of the layers that the legs come from, in every frame.

    Nothing changes where pelvis and legs come from one layer.
    """
    if all(np.array_equal(weights[:, joint], weights[:, 0]) for joint in _LEGS) and weights[:, 0].max() == 1:
        return motion
    toes = [motion.skeleton.index(name) for name in TOE_JOINTS]
    heights = np.stack([_toes(layer, toes) for layer in layers])
    wanted = np.einsum("lt,lft->ft", weights[:, toes], heights).min(axis=1)
    lift = np.zeros((motion.frames, 3), dtype=np.float32)
    lift[:, 1] = wanted - _toes(motion, toes).min(axis=1)
    return replace(motion, root=motion.root + lift)


def _toes(motion: Motion, toes: list[int]) -> Array:
    return motion.positions()[:, toes, 1]
