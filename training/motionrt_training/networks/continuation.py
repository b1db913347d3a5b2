"""A small network that continues a motion under a text: the next frames from the last ones and the text's latent."""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor, nn

POSE = 193  # the first columns of guo263: root, positions, rotations; the rest follows from them


class Continuation(nn.Module):
    """Residual MLP: history (B, H, 193), normalised, and latent (B, d) -> the next K frames (B, K, 193)."""

    mean: Tensor  # (193,)
    std: Tensor  # (193,)

    def __init__(self, history: int = 8, ahead: int = 4, width: int = 1024, blocks: int = 2, d: int = 256) -> None:
        super().__init__()
        self.config = {"history": history, "ahead": ahead, "width": width, "blocks": blocks, "d": d}
        self.history, self.ahead = history, ahead
        self.project = nn.Linear(history * POSE + d, width)
        self.blocks = nn.ModuleList(
            nn.Sequential(nn.LayerNorm(width), nn.Linear(width, width), nn.GELU(), nn.Linear(width, width))
            for _ in range(blocks)
        )
        self.out = nn.Linear(width, ahead * POSE)
        self.register_buffer("mean", torch.zeros(POSE))
        self.register_buffer("std", torch.ones(POSE))

    def forward(self, history: Tensor, latent: Tensor) -> Tensor:
        """The next frames, as changes of the last one."""
        x = self.project(torch.cat((history.flatten(1), latent), dim=1))
        for block in self.blocks:
            x = x + block(x)
        return history[:, -1:] + self.out(F.gelu(x)).unflatten(1, (self.ahead, POSE))

    @torch.no_grad()
    def roll_out(self, start: Tensor, latent: Tensor, frames: int) -> Tensor:
        """Continue raw features (B, H, 193) for `frames` frames -> raw features (B, frames, 193)."""
        history, made = (start - self.mean) / self.std, []
        for _ in range(-(-frames // self.ahead)):
            made.append(self(history, latent))
            history = torch.cat((history, made[-1]), dim=1)[:, -self.history :]
        return torch.cat(made, dim=1)[:, :frames] * self.std + self.mean
