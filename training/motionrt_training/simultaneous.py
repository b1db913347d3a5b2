"""Motions of simultaneous actions: synthetic pairs (SINC 3.1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.composing import Combination, combination, compatible
from motionrt_training.corpora.actions import Action
from motionrt_training.networks.egocentric import WIDTH


def combined(first: Tensor, second: Tensor, parts: Combination) -> Tensor:
    """Compose two egocentric motions (F, 136) as on `sinc135`: each joint from its source, the path with the pelvis."""
    frames = min(len(first), len(second))
    return torch.where(_columns(parts), second[:frames], first[:frames])


def _columns(parts: Combination) -> Tensor:
    joints = torch.from_numpy(np.array(parts.joints[:22]) == 1)
    whole = joints[0].expand(WIDTH - 6 * 22)  # turn, step, height
    return torch.cat((whole, joints.repeat_interleave(6)))


def random_combination(rng: np.random.Generator) -> Combination:
    """Parts dealt out at random, whatever the labels say: the control of SINC's table of synthetic data."""
    count = int(rng.integers(1, len(PARTS)))
    chosen = [PARTS[i] for i in rng.permutation(len(PARTS))[:count]]
    return combination([part for part in PARTS if part not in chosen], chosen, override=True)


def partners(actions: Sequence[Action], first: Action) -> list[int]:
    """The numbers of the actions that may be combined with `first`."""
    return [number for number, other in enumerate(actions) if compatible(first.parts, other.parts)]
