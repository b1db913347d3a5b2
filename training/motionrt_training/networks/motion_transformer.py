"""The transformer that WalkNet and TransNet share: full attention over the frames of a window  [Continual 4.1]."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt_training.networks.transformer import EncoderLayer, key_bias, sinusoidal_positions


class MotionTransformer(nn.Module):
    """Features per frame in, features per frame out: linear, positions, post-norm layers, linear.

    ``patch`` consecutive frames form one token; 1 is the paper's network. The frames must be a multiple of it.
    """

    def __init__(
        self,
        in_dim: int,
        out_dim: int,
        d: int = 512,
        layers: int = 3,
        heads: int = 8,
        ff: int = 1024,
        dropout: float = 0.0,
        patch: int = 1,
    ) -> None:
        super().__init__()
        self.d, self.patch = d, patch
        self.embed = nn.Linear(patch * in_dim, d)
        self.layers = nn.ModuleList(EncoderLayer(d, heads, ff, dropout) for _ in range(layers))
        self.out = nn.Linear(d, patch * out_dim)
        nn.init.zeros_(self.out.weight)  # an untrained network changes nothing
        nn.init.zeros_(self.out.bias)

    def forward(self, x: Tensor) -> Tensor:
        """(B, T, in_dim) -> (B, T, out_dim)."""
        return self.out(self.hidden(x)).unflatten(2, (self.patch, -1)).flatten(1, 2)

    def hidden(self, x: Tensor) -> Tensor:
        """(B, T, in_dim) -> (B, T / patch, d), behind the last layer."""
        h = self.embed(x.unflatten(1, (-1, self.patch)).flatten(2))
        h = h + sinusoidal_positions(h.shape[1], self.d, h)
        bias = key_bias(torch.ones(h.shape[:2], dtype=torch.bool, device=x.device))  # every token is valid
        for layer in self.layers:
            h = layer(h, bias)
        return h
