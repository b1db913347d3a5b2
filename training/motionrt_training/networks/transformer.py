"""Transformer layers with explicit attention, so that no length is baked in when they are exported."""

from __future__ import annotations

import math

import torch
import torch.nn.functional as F
from torch import Tensor, nn

MASKED = -1.0e9  # added to the scores of masked keys: exp() of it is exactly zero in float32 and bfloat16


def sinusoidal_positions(length: int, d: int, like: Tensor) -> Tensor:
    """Positions of Vaswani et al. 2017, 3.5: (length, d), even columns sine, odd columns cosine."""
    step = torch.arange(length, device=like.device, dtype=torch.float32)[:, None]
    even = torch.arange(0, d, 2, device=like.device, dtype=torch.float32)
    rate = torch.exp(even * (-math.log(10000.0) / d))
    angle = step * rate  # (length, d/2)
    return torch.stack((angle.sin(), angle.cos()), dim=-1).flatten(1).to(like.dtype)


def key_bias(mask: Tensor, dtype: torch.dtype = torch.float32) -> Tensor:
    """(B, T) bool, True where valid -> (B, 1, 1, T) to be added to attention scores."""
    return ((~mask).to(dtype) * MASKED)[:, None, None, :]


class Dropout(nn.Module):
    """Dropout from random bytes: on a CPU one Bernoulli number per element costs a third of a training step.

    The rate is rounded to the nearest 1/256; the scale is exact for the rounded rate.
    """

    def __init__(self, rate: float = 0.0) -> None:
        super().__init__()
        if not 0.0 <= rate < 1.0:
            raise ValueError(f"dropout rate {rate} is not in [0, 1)")
        self.dropped = min(255, round(rate * 256))  # byte values below this drop their element

    def forward(self, x: Tensor) -> Tensor:
        """Tokens ``(B, T, d)`` to tokens of the same shape."""
        if not self.training or self.dropped == 0:
            return x
        count = x.numel()
        words = torch.empty((count + 7) // 8, dtype=torch.int64, device=x.device)
        words.random_(-(2**63), None)  # all 64 bits
        keep = (words.view(torch.uint8)[:count] >= self.dropped).view(x.shape)
        return x * keep.to(x.dtype).mul_(256.0 / (256 - self.dropped))


class MultiHeadSelfAttention(nn.Module):
    """Self-attention from Linear, matmul and softmax; `fused` takes torch's kernel instead (same numbers)."""

    def __init__(self, d: int, heads: int) -> None:
        super().__init__()
        if d % heads:
            raise ValueError(f"width {d} is not a multiple of {heads} heads")
        self.heads, self.fused = heads, False
        self.qkv = nn.Linear(d, 3 * d)
        self.out = nn.Linear(d, d)

    def forward(self, x: Tensor, bias: Tensor) -> Tensor:
        """Attend: x (B, T, d), bias (B, 1, 1, T) from `key_bias` -> (B, T, d)."""
        q, k, v = self.split(self.qkv(x), 3)
        mixed = self._fused(q, k, v, bias) if self.fused else self.explicit(q, k, v, bias)
        return self.out(self.join(mixed))

    def split(self, x: Tensor, parts: int) -> tuple[Tensor, ...]:
        """(B, T, parts*d) -> `parts` tensors (B, H, T, d/H)."""
        return x.unflatten(-1, (parts, self.heads, -1)).permute(2, 0, 3, 1, 4).unbind(0)

    def join(self, x: Tensor) -> Tensor:
        """(B, H, T, d/H) -> (B, T, d)."""
        return x.transpose(1, 2).flatten(2)

    def explicit(self, q: Tensor, k: Tensor, v: Tensor, bias: Tensor) -> Tensor:
        """Scaled dot products, softmax, mix: queries (B, H, Q, d/H) over keys and values (B, H, T, d/H)."""
        scores = (q * q.shape[-1] ** -0.5) @ k.transpose(-1, -2) + bias  # (B, H, T, T)
        return scores.softmax(dim=-1).to(v.dtype) @ v

    def _fused(self, q: Tensor, k: Tensor, v: Tensor, bias: Tensor) -> Tensor:
        return F.scaled_dot_product_attention(q, k, v, attn_mask=bias.to(q.dtype))


class FeedForward(nn.Module):
    """Linear, gelu, Linear."""

    def __init__(self, d: int, ff: int, dropout: float = 0.0) -> None:
        super().__init__()
        self.up, self.down, self.drop = nn.Linear(d, ff), nn.Linear(ff, d), Dropout(dropout)

    def forward(self, x: Tensor) -> Tensor:
        """Tokens ``(B, T, d)`` to tokens of the same shape."""
        return self.down(self.drop(F.gelu(self.up(x))))


class EncoderLayer(nn.Module):
    """Post-norm layer: attention, add, norm, feed-forward, add, norm."""

    def __init__(self, d: int, heads: int, ff: int, dropout: float = 0.0, eps: float = 1e-5) -> None:
        super().__init__()
        self.attention = MultiHeadSelfAttention(d, heads)
        self.feed = FeedForward(d, ff, dropout)
        self.norm1, self.norm2 = nn.LayerNorm(d, eps), nn.LayerNorm(d, eps)
        self.drop = Dropout(dropout)

    def forward(self, x: Tensor, bias: Tensor) -> Tensor:
        """Tokens ``(B, T, d)`` to tokens of the same shape."""
        x = self.norm1(x + self.drop(self.attention(x, bias)))
        return self.norm2(x + self.drop(self.feed(x)))


class LatentAttention(nn.Module):
    """Cross-attention to ONE key: its softmax is 1, so it is exactly the value and output projections."""

    def __init__(self, d: int) -> None:
        super().__init__()
        self.value, self.out = nn.Linear(d, d), nn.Linear(d, d)

    def forward(self, latent: Tensor) -> Tensor:
        """(B, d) -> (B, 1, d), the same for every query."""
        return self.out(self.value(latent))[:, None, :]


class DecoderLayer(nn.Module):
    """Post-norm layer with self-attention, attention to one latent, feed-forward."""

    def __init__(self, d: int, heads: int, ff: int, dropout: float = 0.0) -> None:
        super().__init__()
        self.attention = MultiHeadSelfAttention(d, heads)
        self.cross = LatentAttention(d)
        self.feed = FeedForward(d, ff, dropout)
        self.norm1, self.norm2, self.norm3 = nn.LayerNorm(d), nn.LayerNorm(d), nn.LayerNorm(d)
        self.drop = Dropout(dropout)

    def forward(self, x: Tensor, latent: Tensor, bias: Tensor) -> Tensor:
        """Tokens ``(B, T, d)`` to tokens of the same shape."""
        x = self.norm1(x + self.drop(self.attention(x, bias)))
        x = self.norm2(x + self.drop(self.cross(latent)))
        return self.norm3(x + self.drop(self.feed(x)))


class ResidualLayer(nn.Module):
    """Pre-norm layer whose branches begin at zero: a stack of them begins as the identity and learns from there."""

    def __init__(self, d: int, heads: int, ff: int, dropout: float = 0.0, *, latent: bool = False) -> None:
        super().__init__()
        self.attention = MultiHeadSelfAttention(d, heads)
        self.cross = LatentAttention(d) if latent else None
        self.feed = FeedForward(d, ff, dropout)
        self.norm1, self.norm2 = nn.LayerNorm(d), nn.LayerNorm(d)
        self.drop = Dropout(dropout)
        for last in (self.attention.out, self.feed.down, *([self.cross.out] if self.cross else [])):
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)

    def forward(self, x: Tensor, bias: Tensor, latent: Tensor | None = None) -> Tensor:
        """Tokens (B, T, d), bias from `key_bias`, latent (B, d) for a layer that attends to one -> (B, T, d)."""
        x = x + self.drop(self.attention(self.norm1(x), bias))
        if self.cross is not None and latent is not None:
            x = x + self.drop(self.cross(latent))
        return x + self.drop(self.feed(self.norm2(x)))


def set_fused_attention(module: nn.Module, fused: bool) -> None:
    """Choose torch's attention kernel (training) or the explicit one (export) everywhere inside `module`."""
    for part in module.modules():
        if isinstance(part, MultiHeadSelfAttention):
            part.fused = fused
