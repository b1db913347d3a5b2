"""WalkNet and TransNet as they are exported: the numbers of `motionrt_training.networks`, with fewer operators."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt.motion.features.ccf219 import WIDTH
from motionrt_export.layers import Encoder, Norm, constant, linear
from motionrt_export.standing import ORDER, TURNING, Standing, joined, ordered, seen, unseen
from motionrt_training.networks.motion_transformer import MotionTransformer
from motionrt_training.networks.transformer import sinusoidal_positions
from motionrt_training.networks.transnet import (
    FADE,
    GOAL,
    PELVIS,
    TIME,
    TransNet,
    clock,
    fill,
    find_gap,
    frames_at,
    smoothed,
)
from motionrt_training.networks.transnet import FRAMES as WINDOW
from motionrt_training.networks.transnet import _distances as distances
from motionrt_training.networks.transnet import _rates as rates_where_seen
from motionrt_training.networks.walknet import FRAMES as HISTORY
from motionrt_training.networks.walknet import GOAL as AIM
from motionrt_training.networks.walknet import WalkNet

POSES = 3
"""Poses that TransNet sees of every frame: the filled one, and the visible ones before and behind it."""
FEW = 12
"""Tokens up to which the runtime's own layer norm is faster than `Norm`."""


class Hidden(nn.ModuleList):
    """The layers of a `MotionTransformer` over a fixed number of tokens, all of them valid."""

    def __init__(self, source: MotionTransformer, tokens: int, *, first_only: bool = False) -> None:
        last = len(source.layers) - 1
        super().__init__(
            Encoder(layer, first=1 if first_only and index == last else None)
            for index, layer in enumerate(source.layers)
        )
        for layer in self if tokens > FEW else ():
            layer.norm1, layer.norm2 = Norm(layer.norm1), Norm(layer.norm2)

    def forward(self, x: Tensor) -> Tensor:
        """(B, T, d) -> (B, T, d), or (B, 1, d) of the first token."""
        for layer in self:
            x = layer(x)
        return x


class Body(nn.Module):
    """A `MotionTransformer` over a fixed window: columns and rows picked, what all frames hear of the goal apart.

    Args:
        source: the network; its last `heard` columns are the same for all frames.
        frames: length of the window.
        columns: the other columns, in the order in which they come.
        rows, scale: rows of the answer, and what they are multiplied with.
        first_only: answer for the first frame alone.
    """

    def __init__(
        self,
        source: MotionTransformer,
        frames: int,
        columns: Tensor,
        heard: int,
        rows: Tensor,
        scale: Tensor,
        *,
        first_only: bool = False,
    ) -> None:
        super().__init__()
        self.token, self.rows, self.first_only = source.patch * len(columns), len(rows), first_only
        weight = source.embed.weight.unflatten(1, (source.patch, -1))  # (d, patch, columns)
        self.embed = linear(weight[:, :, columns].flatten(1), None)
        self.aim = linear(weight[:, :, -heard:].sum(1), source.embed.bias)
        tokens = frames // source.patch
        self.positions = constant(sinusoidal_positions(tokens, source.d, weight))
        self.layers = Hidden(source, tokens, first_only=first_only)
        answered = 1 if first_only else source.patch  # frames of a token that are answered for
        weight, bias = (
            x.unflatten(0, (source.patch, -1))[:answered, rows] for x in (source.out.weight, source.out.bias)
        )
        self.answer = linear((weight * scale[:, None]).flatten(0, 1), (bias * scale).flatten())

    def forward(self, x: Tensor, heard: Tensor) -> Tensor:
        """(B, T, columns), (B, heard) -> (B, T, rows), or (B, 1, rows)."""
        x = self.embed(x.reshape(x.shape[0], -1, self.token)) + self.positions + self.aim(heard)[:, None]
        x = self.answer(self.layers(x))
        return x if self.first_only else x.reshape(x.shape[0], -1, self.rows)


class WalkNetGraph(nn.Module):
    """The first frame that `WalkNet.forward` predicts: the last layer answers for it alone."""

    def __init__(self, source: WalkNet) -> None:
        super().__init__()
        order = torch.tensor(ORDER)
        columns = torch.cat((order, WIDTH + order))
        self.back, self.changes = constant(order.argsort()), constant(changes(HISTORY))
        self.mean = constant(torch.cat((source.pose_mean[order], torch.zeros(WIDTH))))
        self.rate = constant(1.0 / torch.cat((source.pose_std, source.rate_std))[columns])
        moving = (1.0 - source.still)[order]
        self.moving, self.resting = constant(moving), constant((source.pose_mean * source.still)[order])
        scale = source.change_std[0, order] * moving
        self.body = Body(source.body, HISTORY, columns, AIM + 1, order, scale, first_only=True)

    def forward(self, frames: Tensor, speed: Tensor) -> Tensor:
        """(B, 30, 219), (B,) -> (B, 219)."""
        frames = ordered(frames)
        body = Standing.of(frames[:, -1:])
        local = seen(frames, body) * self.moving + self.resting
        inputs = joined(local, self.changes @ local)  # the matrix takes differences, exactly
        aim = torch.cat((body.goal(), speed[:, None] - 1.0), dim=1)
        change = self.body((inputs - self.mean) * self.rate, aim)
        return unseen(local[:, -1:] + change, body)[:, 0, self.back]


class TransNetGraph(nn.Module):
    """`TransNet.forward` over 120 frames."""

    def __init__(self, source: TransNet) -> None:
        super().__init__()
        order = torch.tensor(ORDER)
        pelvis = torch.tensor([c if c < 9 else c - WIDTH + PELVIS for c in ORDER[:PELVIS]])  # among the 12 columns
        rate_std, change_std = source.rate_std[order], source.change_std[order]
        pose_mean, pose_std = source.pose_mean[order].repeat(POSES), source.pose_std[order].repeat(POSES)
        means = pose_mean, torch.zeros(WIDTH), source.seed_mean[pelvis], torch.zeros(PELVIS)
        stds = pose_std, rate_std, source.seed_std[pelvis], rate_std[:PELVIS]
        self.back, self.mean, self.rate = (
            constant(x) for x in (order.argsort(), torch.cat(means), 1.0 / torch.cat(stds))
        )
        whole = [part * WIDTH + order for part in range(POSES + 1)]
        parts = [(POSES + 1) * WIDTH + part * PELVIS + pelvis for part in range(2)]
        columns = torch.cat((*whole, *parts, (POSES + 1) * WIDTH + 2 * PELVIS + torch.arange(TIME)))
        rows, scale = torch.cat((order, WIDTH + pelvis)), torch.cat((change_std, change_std[:PELVIS]))
        self.body = Body(source.body, WINDOW, columns, GOAL, rows, scale)
        self.smooth = constant(smoothed(torch.eye(WINDOW)[None])[0])

    def forward(self, frames: Tensor, hidden: Tensor) -> Tensor:
        """(B, 120, 219), (B, 120) bool -> (B, 120, 219)."""
        gap = find_gap(hidden)
        line = fill(ordered(frames).masked_fill(hidden[..., None], 0.0), gap)
        target = Standing.of(line[:, -1:])
        line = seen(line, target)
        seed = Standing.of(line.gather(1, gap.last_seed[:, None, None].expand(-1, 1, 2 * TURNING)))
        from_start, to_end = distances(gap, hidden)
        rates, ends = (
            rates_where_seen(line, hidden, gap.before),
            (frames_at(line, at) for at in (gap.before, gap.after)),
        )
        turned = seen(line[:, :, :PELVIS], seed), seen(rates[:, :, :PELVIS], seed.turn())
        inputs = joined(
            (joined(line, *ends, rates, *turned) - self.mean) * self.rate, clock(hidden, from_start, to_end)
        )
        answer = self.smooth @ self.body(inputs, seed.goal())
        change, pelvis = answer.split((WIDTH, PELVIS), dim=2)
        window = ((1.0 - torch.exp(from_start * (-1.0 / FADE))) * (1.0 - torch.exp(to_end * (-1.0 / FADE))))[..., None]
        share = (from_start / (from_start + to_end).clamp(min=1.0))[..., None]
        line, pelvis = line + change * window, unseen(pelvis * (window * (1.0 - share)), seed.turn())
        line = joined(line[:, :, :PELVIS] + pelvis, line[:, :, PELVIS:])
        return torch.where(hidden[..., None], unseen(line, target)[:, :, self.back], frames)


def changes(length: int) -> Tensor:
    """The matrix (T, T) that takes every row's difference from the row before; the first row has that of the second."""
    steps = torch.eye(length) - torch.diag(torch.ones(length - 1), -1)
    steps[0] = steps[1]
    return steps
