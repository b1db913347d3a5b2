"""The layers as they are exported: the numbers of `motionrt_training.networks`, with fewer operators."""

from __future__ import annotations

import math

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training.networks.transformer import (
    DecoderLayer,
    EncoderLayer,
    LatentAttention,
    MultiHeadSelfAttention,
    ResidualLayer,
)


def linear(weight: Tensor, bias: Tensor | None) -> nn.Linear:
    """A Linear holding these values: weight (out, in), bias (out,) or none."""
    made = nn.Linear(weight.shape[1], weight.shape[0], bias=bias is not None)
    made.weight = constant(weight)
    if bias is not None:
        made.bias = constant(bias)
    return made


def constant(value: Tensor) -> nn.Parameter:
    """A value that is stored in the graph."""
    return nn.Parameter(value.detach().clone(), requires_grad=False)


class Attention(nn.Module):
    """Self-attention; the query weights hold the factor 1/sqrt(d/heads) where that is exact, a power of two.

    `first` computes the answers of so many tokens alone, exactly: keys and values come from all tokens.
    """

    def __init__(self, source: MultiHeadSelfAttention, *, first: int | None = None) -> None:
        super().__init__()
        d = source.out.in_features
        self.d, self.heads, self.first = d, source.heads, first
        scale = (d // source.heads) ** -0.5
        self.scale = 1.0 if math.frexp(scale)[0] == 0.5 else scale
        scale /= self.scale
        q, k, v = (source.qkv.weight[part * d : (part + 1) * d] for part in range(3))
        bq, bk, bv = (source.qkv.bias[part * d : (part + 1) * d] for part in range(3))
        if first is not None:
            self.q = linear(q * scale, bq * scale)
            self.kv = linear(torch.cat((k, v)), torch.cat((bk, bv)))
        else:
            self.qkv = linear(torch.cat((q * scale, k, v)), torch.cat((bq * scale, bk, bv)))
        self.out = linear(source.out.weight, source.out.bias)

    def forward(self, x: Tensor, bias: Tensor | None = None) -> Tensor:
        """X (B, T, d), bias (B, 1, 1 or answers, T) or none -> (B, T, d), or (B, first, d) of the first tokens."""
        if self.first is not None:
            q = self._split(self.q(x[:, : self.first]), 1)
            k, v = self._split(self.kv(x), 2).split(self.heads, dim=1)
        else:
            q, k, v = self._split(self.qkv(x), 3).split(self.heads, dim=1)  # (B, H, T, d/H)
        q = q if self.scale == 1.0 else q * self.scale
        scores = q @ k.transpose(-1, -2)
        mixed = (scores if bias is None else scores + bias).softmax(dim=-1) @ v
        return self.out(mixed.transpose(1, 2).reshape(x.shape[0], -1, self.d))

    def _split(self, x: Tensor, parts: int) -> Tensor:
        """(B, T, parts * d) -> (B, parts * H, T, d/H)."""
        return x.view(x.shape[0], -1, parts * self.heads, self.d // self.heads).transpose(1, 2)


class FeedForward(nn.Module):
    """Linear, gelu, Linear."""

    def __init__(self, up: nn.Linear, down: nn.Linear) -> None:
        super().__init__()
        self.up, self.down = linear(up.weight, up.bias), linear(down.weight, down.bias)

    def forward(self, x: Tensor) -> Tensor:
        """As the layer that it replaces."""
        return self.down(F.gelu(self.up(x)))


class Encoder(nn.Module):
    """One post-norm encoder layer."""

    def __init__(self, source: EncoderLayer, *, first: int | None = None) -> None:
        super().__init__()
        self.first = first
        self.attention = Attention(source.attention, first=first)
        self.feed = FeedForward(source.feed.up, source.feed.down)
        self.norm1, self.norm2 = source.norm1, source.norm2

    def forward(self, x: Tensor, bias: Tensor | None = None) -> Tensor:
        """As the layer that it replaces."""
        kept = x if self.first is None else x[:, : self.first]
        x = self.norm1(kept + self.attention(x, bias))
        return self.norm2(x + self.feed(x))


class Decoder(nn.Module):
    """One post-norm decoder layer; what it hears of the latent comes ready from `folded`."""

    def __init__(self, source: DecoderLayer) -> None:
        super().__init__()
        self.attention = Attention(source.attention)
        self.feed = FeedForward(source.feed.up, source.feed.down)
        self.norm1, self.norm2, self.norm3 = source.norm1, source.norm2, source.norm3

    def forward(self, x: Tensor, heard: Tensor, bias: Tensor) -> Tensor:
        """X (B, T, d), heard (B, 1, d)."""
        x = self.norm1(x + self.attention(x, bias))
        x = self.norm2(x + heard)
        return self.norm3(x + self.feed(x))


class Residual(nn.Module):
    """One pre-norm layer; what it hears of a latent comes ready from `folded`."""

    def __init__(self, source: ResidualLayer, *, first: int | None = None) -> None:
        super().__init__()
        self.first = first
        self.attention = Attention(source.attention, first=first)
        self.feed = FeedForward(source.feed.up, source.feed.down)
        self.norm1, self.norm2 = source.norm1, source.norm2

    def forward(self, x: Tensor, bias: Tensor, heard: Tensor | None = None) -> Tensor:
        """X (B, T, d), heard (B, 1, d) -> (B, T, d), or (B, first, d) of the first tokens."""
        kept = x if self.first is None else x[:, : self.first]
        x = kept + self.attention(self.norm1(x), bias)
        x = x if heard is None else x + heard
        return x + self.feed(self.norm2(x))


def folded(attentions: list[LatentAttention]) -> nn.Linear:
    """Attention to one latent is value and output projection in a row: one Linear for all."""
    weights = [part.out.weight.double() @ part.value.weight.double() for part in attentions]
    biases = [part.out.weight.double() @ part.value.bias.double() + part.out.bias.double() for part in attentions]
    return linear(torch.cat(weights).float(), torch.cat(biases).float())
