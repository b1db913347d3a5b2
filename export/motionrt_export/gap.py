"""The gap that TransNet fills as the exported graph sees it: one, that begins behind the seed, of any length.

All that the network wants to know of it depends on its length alone, and is looked up.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from motionrt_export.layers import constant
from motionrt_training.networks.transnet import FADE, FRAMES, SEED, clock, fill, find_gap
from motionrt_training.networks.transnet import _distances as distances

REST = FRAMES - SEED
"""Frames behind the seed, the last of which is visible."""
ENDS = 4
"""Frames that a gap is filled from: the last two of the seed, and the first two behind it."""


class Gap(NamedTuple):
    """A gap in the frames behind the seed, (B, R) of them."""

    there: Tensor  # (B, R, 1) bool: is the frame hidden
    known: Tensor  # (B, R, 1) 1 where the frame and the one before it are visible
    window: Tensor  # (B, R, 1) 0 at visible frames
    early: Tensor  # (B, R, 1) the window, and how near the seed is
    coasting: Tensor  # (B, R, 4) shares of the four frames around it in every hidden one
    clock: Tensor  # (B, R, 8)
    behind: Tensor  # (B, 2, R) picks the first two frames behind it, nothing where the window ends before


class Gaps(nn.Module):
    """Tables of what there is to know of gaps of 0, 1, ... 60 frames; nobody asks for the last, which has no end."""

    def __init__(self) -> None:
        super().__init__()
        lengths = torch.arange(REST + 1)
        hidden = torch.arange(FRAMES) < SEED + lengths[:, None]
        hidden &= torch.arange(FRAMES) >= SEED
        gap = find_gap(hidden)
        passed, left = distances(gap, hidden)
        window = (1.0 - torch.exp(-passed / FADE)) * (1.0 - torch.exp(-left / FADE))
        early = window * (1.0 - passed / (passed + left).clamp(min=1.0))
        known = ~(hidden | hidden.roll(1, dims=1))
        single = torch.stack((known.float(), window, early), dim=2)
        rows = torch.cat((single, coasting(hidden, lengths), clock(hidden, passed, left)), dim=2)
        self.rows = constant(rows[:, SEED:])
        first = lengths[:, None] + torch.arange(2)
        self.behind = constant((first[:, :, None] == torch.arange(REST)).float())

    def forward(self, hidden: Tensor) -> Gap:
        """(B, R) bool behind the seed."""
        length = hidden.sum(1)
        rows = self.rows[length].split((1, 1, 1, ENDS, self.rows.shape[2] - ENDS - 3), dim=2)
        return Gap(hidden[:, :, None], *rows, self.behind[length])


def coasting(hidden: Tensor, lengths: Tensor) -> Tensor:
    """(L, T, 4): the share that each of the four frames around a gap has in every frame when it is filled."""
    start = torch.full_like(lengths, SEED)
    around = torch.stack((start - 2, start - 1, start + lengths, start + lengths + 1), dim=1)
    return fill((torch.arange(FRAMES)[:, None] == around[:, None]).float(), find_gap(hidden))
