"""The denoiser of motions: a transformer over patches of frames, told a text, slots, numbers and what is held."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt.synthesis.motion_diffusion import held_columns
from motionrt.text import SLOTS, TARGETS
from motionrt_training.networks.actor import patched
from motionrt_training.networks.transformer import MASKED

KERNEL = (0.5, 0.228, 0.022)  # a Gaussian of 0.8 frames: what is faster than half a period of four frames goes
WAY = 1  # the first column, the turn, which guidance makes larger than it was meant

CLASSES = tuple(SLOTS.values())
OWNERS = tuple(held_columns().tolist())


@dataclass(frozen=True)
class Condition:
    """What the denoiser is told, of B motions of F frames.

    Attributes:
        frames: (B, F) bool, true for frames that are there.
        tokens, text: (B, T, 384) token features of a text, and (B, T) bool which of them may be seen.
        slots: (B, S) int64 classes, 0 unknown.
        targets, known: (B, A) numbers of what the motion does, and (B, A) bool which are given.
        held, holding: (B, F, 77) raw features to keep, and (B, F, 6) which parts of which frames they are given for.
    """

    frames: Tensor
    tokens: Tensor
    text: Tensor
    slots: Tensor
    targets: Tensor
    known: Tensor
    held: Tensor
    holding: Tensor


class MotionDenoiser(nn.Module):
    """Estimates clean ``ego77`` motions from noisy ones (diffusion transformer, Peebles and Xie 2023, adaLN-zero).

    `patch` frames form a token; tokens of the text are further keys and values of every layer. The answer is the motion
    itself and not the noise, which has more numbers a token than `d`, and it is smoothed over time.
    """

    def __init__(
        self,
        width: int = 77,
        patch: int = 4,
        d: int = 256,
        layers: int = 6,
        heads: int = 4,
        ff: int = 1024,
        text: int = 384,
        slots: Sequence[int] = CLASSES,
        targets: int = len(TARGETS),
        owners: Sequence[int] = OWNERS,
        *,
        longest: int = 50,
    ) -> None:
        super().__init__()
        self.config = {
            "width": width, "patch": patch, "d": d, "layers": layers, "heads": heads, "ff": ff, "text": text,
            "slots": list(slots), "targets": targets, "owners": list(owners), "longest": longest,
        }  # fmt: skip
        self.patch, self.width = patch, width
        parts = max(owners) + 1
        self.register_buffer("mean", torch.zeros(width))
        self.register_buffer("std", torch.ones(width))
        self.register_buffer("owners", torch.tensor(owners), persistent=False)
        self.enter = nn.Linear(patch * (2 * width + parts), d)
        self.from_start = nn.Parameter(torch.randn(longest, d) * 0.02)
        self.from_end = nn.Parameter(torch.randn(longest, d) * 0.02)
        self.level = nn.Sequential(nn.Linear(128, d), nn.SiLU(), nn.Linear(d, d))
        self.read = nn.Sequential(nn.LayerNorm(text), nn.Linear(text, d))
        self.gist = nn.Sequential(nn.Linear(d, d), nn.SiLU(), nn.Linear(d, d))
        self.numbers = nn.Linear(2 * targets, d)
        self.slots = nn.ModuleList(nn.Embedding(count, d, padding_idx=0) for count in slots)
        for slot in self.slots:
            slot.weight.data.mul_(0.3)
        self.layers = nn.ModuleList(DenoiserLayer(d, heads, ff) for _ in range(layers))
        self.norm = nn.LayerNorm(d, elementwise_affine=False)
        self.modulate = nn.Linear(d, 2 * d)
        self.leave = nn.Linear(d, patch * width)
        for last in (self.modulate, self.leave):
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)

    def normalise(self, motion: Tensor) -> Tensor:
        """Raw features (..., 77) to those of zero mean and about unit variance."""
        return (motion - self.mean) / self.std

    def denormalise(self, motion: Tensor) -> Tensor:
        """The inverse of `normalise`."""
        return motion * self.std + self.mean

    def forward(self, noisy: Tensor, level: Tensor, told: Condition) -> Tensor:
        """Noisy normalised motions (B, F, 77) with noise levels (B,) -> estimates of the clean ones (B, F, 77)."""
        scaled = noisy * (1 + level.square()).rsqrt()[:, None, None]
        holding = told.holding.to(noisy.dtype)
        kept = self.normalise(told.held) * holding[..., self.owners]
        patches, valid = patched(torch.cat([scaled, kept, holding], dim=-1), told.frames, self.patch)
        x, count = self.enter(patches), valid.sum(1)
        steps = torch.arange(valid.shape[1], device=x.device)
        behind = (count[:, None] - 1 - steps).clamp(min=0)
        x = x + self.from_start[: valid.shape[1]] + self.from_end[behind]
        words = self.read(told.tokens)
        c = F.silu(self._gathered(level, words, told))
        bias = (~torch.cat([valid, told.text], dim=1)).to(x.dtype)[:, None, None] * MASKED
        for layer in self.layers:
            x = layer(x, words, c, bias)
        scale, shift = self.modulate(c[:, None]).split(self.leave.in_features, dim=-1)
        found = self.leave(self.norm(x) * (1 + scale) + shift)
        found = found.unflatten(2, (self.patch, self.width)).flatten(1, 2)[:, : noisy.shape[1]]
        there = told.frames[..., None].to(found.dtype)
        return smoothed(found * there) / smoothed(there).clamp(min=1e-3)

    def guided(self, noisy: Tensor, level: Tensor, told: Condition, guidance: Tensor) -> Tensor:
        """Estimates with classifier-free guidance (Ho and Salimans 2022, eq. 6): (B, 2), of the way and the rest.

        What is held is told to both estimates and stands in the answer as it was given.
        """
        blank = replace(
            told,
            text=torch.zeros_like(told.text),
            slots=torch.zeros_like(told.slots),
            known=torch.zeros_like(told.known),
        )
        fields = [(getattr(told, name), getattr(blank, name)) for name in Condition.__dataclass_fields__]
        both = Condition(*(torch.cat(pair) for pair in fields))
        found = self(torch.cat([noisy, noisy]), torch.cat([level, level]), both)
        with_it, without = found.chunk(2)
        weight = guidance[:, None, [0] * WAY + [1] * (self.width - WAY)]
        kept = told.holding[..., self.owners]
        return torch.where(kept, self.normalise(told.held), without + weight * (with_it - without))

    def _gathered(self, level: Tensor, words: Tensor, told: Condition) -> Tensor:
        """One vector (B, d) of all that is not in a token of its own."""
        rate = torch.exp(torch.arange(64, device=level.device) * (-math.log(1000.0) / 64))
        angle = level.log()[:, None] * 10 * rate
        c = self.level(torch.cat([angle.sin(), angle.cos()], dim=-1))
        seen = told.text.to(words.dtype)[..., None]
        c = c + self.gist((words * seen).sum(1) / seen.sum(1).clamp(min=1))
        known = told.known.to(words.dtype)
        c = c + self.numbers(torch.cat([told.targets * known, known], dim=-1))
        for number, slot in enumerate(self.slots):
            c = c + slot(told.slots[:, number])
        return c


def smoothed(x: Tensor) -> Tensor:
    """Means (B, F, D) over five frames each by `KERNEL`, zeros beyond the ends."""
    padded = F.pad(x, (0, 0, 2, 2))
    count = x.shape[1]
    near, far = padded[:, 1 : 1 + count] + padded[:, 3 : 3 + count], padded[:, :count] + padded[:, 4 : 4 + count]
    return KERNEL[0] * x + KERNEL[1] * near + KERNEL[2] * far


class DenoiserLayer(nn.Module):
    """Attention to motion and text, feed-forward; both scaled, shifted and gated by the condition (adaLN-zero)."""

    def __init__(self, d: int, heads: int, ff: int) -> None:
        super().__init__()
        self.d, self.heads = d, heads
        self.norm1 = nn.LayerNorm(d, elementwise_affine=False)
        self.norm2 = nn.LayerNorm(d, elementwise_affine=False)
        self.qkv, self.out = nn.Linear(d, 3 * d), nn.Linear(d, d)
        self.words = nn.Linear(d, 2 * d)
        self.up, self.down = nn.Linear(d, ff), nn.Linear(ff, d)
        self.modulate = nn.Linear(d, 6 * d)
        nn.init.zeros_(self.modulate.weight)
        nn.init.zeros_(self.modulate.bias)

    def forward(self, x: Tensor, words: Tensor, c: Tensor, bias: Tensor) -> Tensor:
        """Tokens (B, T, d), words (B, W, d), condition (B, d), bias (B, 1, 1, T + W) -> (B, T, d)."""
        scale1, shift1, gate1, scale2, shift2, gate2 = self.modulate(c[:, None]).split(self.d, dim=-1)
        q, k, v = self._split(self.qkv(self.norm1(x) * (1 + scale1) + shift1), 3)
        more_k, more_v = self._split(self.words(words), 2)
        k, v = torch.cat([k, more_k], dim=2), torch.cat([v, more_v], dim=2)
        scores = (q * (self.d // self.heads) ** -0.5) @ k.transpose(-1, -2) + bias
        mixed = (scores.softmax(dim=-1) @ v).transpose(1, 2)
        x = x + gate1 * self.out(mixed.reshape(mixed.shape[0], -1, self.d))
        return x + gate2 * self.down(F.relu(self.up(self.norm2(x) * (1 + scale2) + shift2)))

    def _split(self, x: Tensor, parts: int) -> tuple[Tensor, ...]:
        split = x.view(x.shape[0], -1, parts * self.heads, self.d // self.heads).transpose(1, 2)
        return split.split(self.heads, dim=1)
