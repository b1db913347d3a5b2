"""The same layers without padding, for training, with the numbers of the plain path.

Only attention sees the padded shape, and the last encoder layer is computed for the two distribution tokens
alone, the only ones that are read.
"""

from __future__ import annotations

from typing import Any

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training.networks.transformer import key_bias


class Ragged:
    """Where the valid tokens of a (B, T) mask lie."""

    def __init__(self, mask: Tensor, dtype: torch.dtype) -> None:
        self.shape = mask.shape
        self.rows = mask.flatten().nonzero().squeeze(1)  # (N,) of the B*T positions
        self.owner = self.rows // mask.shape[1]  # (N,) the sequence of each token
        self.first = mask.sum(1).cumsum(0) - mask.sum(1)  # (B,) the first token of each sequence among the N
        self.bias = key_bias(mask, dtype)

    def pack(self, x: Tensor) -> Tensor:
        """(B, T, C) -> (N, C)."""
        return x.flatten(0, 1).index_select(0, self.rows)

    def spread(self, x: Tensor) -> Tensor:
        """(N, C) -> (B, T, C), zeros where nothing is valid."""
        empty = x.new_zeros(self.shape[0] * self.shape[1], x.shape[1])
        return empty.index_copy(0, self.rows, x).unflatten(0, tuple(self.shape))


def encode_ragged(layers: nn.ModuleList, x: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
    """Encoder layers over x (B, T, d) whose first two tokens are valid -> those two tokens, (B, d) each."""
    ragged = Ragged(mask, x.dtype)
    x = ragged.pack(x)
    for layer in layers[:-1]:
        x = _feed(layer, _attend(layer, x, ragged), layer.norm2)
    x = _last(layers[-1], x, ragged).unflatten(0, (-1, 2))  # (B, 2, d)
    return x[:, 0], x[:, 1]


def decode_ragged(layers: nn.ModuleList, x: Tensor, latent: Tensor, mask: Tensor, project: nn.Module) -> Tensor:
    """Decoder layers and output projection over x (B, T, d) -> (B, T, out), zeros where the mask is False."""
    ragged = Ragged(mask, latent.dtype)
    x = ragged.pack(x)
    for part in layers:
        layer: Any = part
        x = _attend(layer, x, ragged)
        cross = layer.drop(layer.cross(latent)).squeeze(1)  # (B, d)
        x = layer.norm2(x + cross.index_select(0, ragged.owner))
        x = _feed(layer, x, layer.norm3)
    return ragged.spread(project(x))


def _attend(layer: Any, x: Tensor, ragged: Ragged) -> Tensor:
    attention = layer.attention
    q, k, v = attention.split(ragged.spread(attention.qkv(x)), 3)
    mixed = attention.join(attention.explicit(q, k, v, ragged.bias))
    return layer.norm1(x + layer.drop(attention.out(ragged.pack(mixed))))


def _feed(layer: Any, x: Tensor, norm: Any) -> Tensor:
    return norm(x + layer.drop(layer.feed(x)))


def _last(layer: Any, x: Tensor, ragged: Ragged) -> Tensor:
    attention, d = layer.attention, x.shape[1]
    weight, bias = attention.qkv.weight, attention.qkv.bias
    two = x.index_select(0, torch.stack((ragged.first, ragged.first + 1), dim=1).flatten())  # (2B, d)
    (q,) = attention.split(F.linear(two, weight[:d], bias[:d]).unflatten(0, (-1, 2)), 1)
    k, v = attention.split(ragged.spread(F.linear(x, weight[d:], bias[d:])), 2)
    mixed = attention.join(attention.explicit(q, k, v, ragged.bias)).flatten(0, 1)
    return _feed(layer, layer.norm1(two + layer.drop(attention.out(mixed))), layer.norm2)
