"""ACTOR-style encoder (two distribution tokens) and decoder (positions as queries) over masked sequences."""

from __future__ import annotations

from typing import NamedTuple

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training.networks.ragged import decode_ragged, encode_ragged
from motionrt_training.networks.transformer import (
    DecoderLayer,
    Dropout,
    EncoderLayer,
    key_bias,
    sinusoidal_positions,
)

# Layer normalisation leaves both tokens with unit variance, so samples would start with as much noise as signal, and
# a KL weight of 1e-5 takes very long to change that. Starting from a standard deviation of 0.14 saves the time.
FIRST_LOGVAR = -4.0


class Distribution(NamedTuple):
    """A diagonal Gaussian: mu (B, d), logvar (B, d)."""

    mu: Tensor
    logvar: Tensor

    def sample(self, noise: Tensor | None = None) -> Tensor:
        """Reparametrised sample (B, d)."""
        noise = torch.randn_like(self.mu) if noise is None else noise
        return self.mu + noise * (0.5 * self.logvar).exp()


def patched(x: Tensor, mask: Tensor, patch: int) -> tuple[Tensor, Tensor]:
    """Join `patch` frames to a token: (B, F, D), (B, F) -> (B, ceil(F/patch), patch*D), (B, ceil(F/patch)).

    Frames beyond the mask are zeroed, the tail is padded; a token is valid when its first frame is.
    """
    x = x * mask[..., None].to(x.dtype)
    if patch == 1:
        return x, mask
    frames = x.shape[1]
    padded = F.pad(x, (0, 0, 0, patch - 1))
    # Strided slices have ceil(F/patch) rows each: no division, hence nothing for an exporter to bake in.
    tokens = torch.cat([padded[:, first : first + frames : patch] for first in range(patch)], dim=-1)
    return tokens, mask[:, ::patch]


class ActorEncoder(nn.Module):
    """Sequence -> Distribution, read from two learned tokens that are put in front."""

    def __init__(
        self,
        in_dim: int,
        d: int = 256,
        layers: int = 6,
        heads: int = 4,
        ff: int = 1024,
        dropout: float = 0.1,
        patch: int = 1,
    ) -> None:
        super().__init__()
        self.d, self.patch = d, patch
        self.project = nn.Linear(in_dim * patch, d)
        self.tokens = nn.Parameter(torch.randn(2, d))  # mu, logvar
        self.layers = nn.ModuleList(EncoderLayer(d, heads, ff, dropout) for _ in range(layers))
        self.drop = Dropout(dropout)

    def forward(self, x: Tensor, mask: Tensor) -> Distribution:
        """Read x (B, F, in_dim), mask (B, F) bool, True where valid -> mu and logvar (B, d)."""
        x, mask = patched(x, mask, self.patch)
        x = self.project(x)  # (B, T, d)
        x = torch.cat((self.tokens.to(x.dtype).expand(x.shape[0], -1, -1), x), dim=1)
        x = self.drop(x + sinusoidal_positions(x.shape[1], self.d, x))
        mask = F.pad(mask, (2, 0), value=True)
        mu, logvar = encode_ragged(self.layers, x, mask) if self.training else self._encode(x, mask)
        return Distribution(mu.float(), logvar.float() + FIRST_LOGVAR)

    def _encode(self, x: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
        """The two distribution tokens (B, d) each, of tokens (B, T, d) with mask (B, T)."""
        bias = key_bias(mask, x.dtype)
        for layer in self.layers:
            x = layer(x, bias)
        return x[:, 0], x[:, 1]


class ActorDecoder(nn.Module):
    """Latent -> sequence: positions are the queries, every layer attends to the one latent."""

    def __init__(
        self,
        out_dim: int,
        d: int = 256,
        layers: int = 6,
        heads: int = 4,
        ff: int = 1024,
        dropout: float = 0.1,
        patch: int = 1,
    ) -> None:
        super().__init__()
        self.d, self.patch, self.out_dim = d, patch, out_dim
        self.layers = nn.ModuleList(DecoderLayer(d, heads, ff, dropout) for _ in range(layers))
        self.project = nn.Linear(d, out_dim * patch)
        self.drop = Dropout(dropout)

    def forward(self, latent: Tensor, mask: Tensor) -> Tensor:
        """Decode latent (B, d), mask (B, F) bool -> (B, F, out_dim); zeros where the mask is False."""
        valid = mask[:, :: self.patch]  # (B, T)
        positions = sinusoidal_positions(valid.shape[1], self.d, latent)
        x = self.drop(positions.expand(latent.shape[0], -1, -1))
        if self.training:
            x = decode_ragged(self.layers, x, latent, valid, self.project)
        else:
            bias = key_bias(valid, latent.dtype)
            for layer in self.layers:
                x = layer(x, latent, bias)
            x = self.project(x)
        frames = x.unflatten(-1, (self.patch, self.out_dim)).flatten(1, 2)  # (B, T*patch, out)
        return frames[:, : mask.shape[1]].float() * mask[..., None]
