"""WalkNet and TransNet as they are exported: the numbers of `motionrt_training.networks`, with fewer operators."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt.motion.features.ccf219 import WIDTH
from motionrt_export.gap import Gap, Gaps
from motionrt_export.layers import Encoder, constant, linear
from motionrt_export.standing import ORDER, Standing, in_columns, joined, ordered, seen, unseen
from motionrt_training.networks.motion_transformer import MotionTransformer
from motionrt_training.networks.transformer import EncoderLayer, sinusoidal_positions
from motionrt_training.networks.transnet import FRAMES as WINDOW
from motionrt_training.networks.transnet import GOAL, PELVIS, SEED, TIME, TransNet, smoothed
from motionrt_training.networks.walknet import FRAMES as HISTORY
from motionrt_training.networks.walknet import GOAL as AIM
from motionrt_training.networks.walknet import WISHES, WalkNet, turned_wish

POSES = 3
"""Poses that TransNet sees of every frame: the filled one, and the visible ones before and behind it."""
REACH = 2
"""Frames to either side that TransNet's answers are smoothed over."""


class PostNorm(Encoder):
    """One post-norm layer whose branches are subtracted, with weights of the other sign.

    A sum in front of a layer norm would be fused with it by onnxruntime, whose kernel for both takes five times as
    long as its layer norm does.
    """

    def __init__(self, source: EncoderLayer, *, first: int | None = None) -> None:
        super().__init__(source, first=first)
        for last in (self.attention.out, self.feed.down):
            last.weight, last.bias = constant(-last.weight), constant(-last.bias)

    def forward(self, x: Tensor, bias: Tensor | None = None) -> Tensor:
        """As the layer that it replaces."""
        kept = x if self.first is None else x[:, : self.first]
        x = self.norm1(kept - self.attention(x, bias))
        return self.norm2(x - self.feed(x))


class Hidden(nn.ModuleList):
    """The layers of a `MotionTransformer` over a fixed number of tokens, all of them valid; the last for the first."""

    def __init__(self, source: MotionTransformer, *, first: int | None = None) -> None:
        last = len(source.layers) - 1
        super().__init__(
            PostNorm(layer, first=first if index == last else None) for index, layer in enumerate(source.layers)
        )

    def forward(self, x: Tensor) -> Tensor:
        """(B, T, d) -> (B, T, d), or (B, first, d) of the first tokens."""
        for layer in self:
            x = layer(x)
        return x


class Body(nn.Module):
    """A `MotionTransformer` over a fixed window: columns and rows picked, what all frames hear of the goal apart.

    Args:
        source: the network; its last `heard` columns are the same for all frames.
        times: which frame of the window each frame is, whole tokens of neighbours.
        columns: the other columns, in the order in which they come.
        rows, scale: rows of the answer, and what they are multiplied with.
        first: answer for so many tokens alone.
        frames: and for so many frames of each.
    """

    def __init__(
        self,
        source: MotionTransformer,
        times: Tensor,
        columns: Tensor,
        heard: int,
        rows: Tensor,
        scale: Tensor,
        *,
        first: int,
        frames: int | None = None,
    ) -> None:
        super().__init__()
        self.token, self.rows = source.patch * len(columns), len(rows)
        weight = source.embed.weight.unflatten(1, (source.patch, -1))  # (d, patch, columns)
        self.embed = linear(weight[:, :, columns].flatten(1), None)
        self.aim = linear(weight[:, :, -heard:].sum(1), source.embed.bias)
        positions = sinusoidal_positions(len(times) // source.patch, source.d, weight)
        self.positions = constant(positions[times[:: source.patch] // source.patch])
        self.layers = Hidden(source, first=first)
        weight, bias = (x.unflatten(0, (source.patch, -1))[:frames, rows] for x in (source.out.weight, source.out.bias))
        self.answer = linear((weight * scale[:, None]).flatten(0, 1), (bias * scale).flatten())

    def forward(self, x: Tensor, heard: Tensor) -> Tensor:
        """(B, T, columns), (B, heard) -> (B, answered frames, rows)."""
        x = self.embed(x.reshape(x.shape[0], -1, self.token)) + self.positions + self.aim(heard)[:, None]
        return self.answer(self.layers(x)).reshape(x.shape[0], -1, self.rows)


class WalkNetGraph(nn.Module):
    """The first frame that `WalkNet.forward` predicts: the last layer answers for it alone."""

    def __init__(self, source: WalkNet) -> None:
        super().__init__()
        order = torch.tensor(ORDER)
        columns = torch.cat((order, WIDTH + order))
        self.changes = constant(changes(HISTORY))
        moving = (1.0 - source.still)[order]
        self.mean, self.rate = constant(source.pose_mean[order]), constant(moving / source.pose_std[order])
        self.change_rate = constant(moving / source.rate_std[order])
        self.moving, self.resting = constant(moving), constant((source.pose_mean * source.still)[order])
        scale = source.change_std[0, order] * moving
        heard = AIM + 1 + WISHES * source.wishes
        self.body = Body(source.body, torch.arange(HISTORY), columns, heard, order, scale, first=1, frames=1)
        self.wishes = source.wishes

    def forward(self, frames: Tensor, speed: Tensor, wish: Tensor | None = None) -> Tensor:
        """(B, 30, 219), (B,) and wishes (B, 8), of a network that knows them -> (B, 219)."""
        frames = ordered(frames)
        body = Standing.of(frames[:, -1:])
        return in_columns(self.step(frames, body, body.goal(), speed, wish))[:, 0]

    def step(self, frames: Tensor, body: Standing, goal: Tensor, speed: Tensor, wish: Tensor | None = None) -> Tensor:
        """Frames (B, 30, 219) in `ORDER`, the last one's body, the goal as it sees it (B, 7) -> (B, 1, 219)."""
        local = seen(frames, body)
        changes = self.changes @ local  # the matrix takes differences, exactly
        inputs = joined((local - self.mean) * self.rate, changes * self.change_rate)
        change = self.body(inputs, self._heard(torch.cat((goal, speed[:, None] - 1.0), dim=1), body, wish))
        return unseen(local[:, -1:] * self.moving + self.resting + change, body)

    def _heard(self, aim: Tensor, body: Standing, wish: Tensor | None) -> Tensor:
        """(B, 8 or 16): the goal and the speed, of which a wished velocity takes the place, and the wishes."""
        if not self.wishes:
            return aim
        if wish is None:
            return torch.cat((aim, torch.zeros_like(aim)), dim=1)  # as many wishes as columns of the aim
        turn = torch.cat((body.cos, body.sin), dim=2)[:, 0]
        return torch.cat((aim * (1.0 - wish[:, :1]), turned_wish(wish, turn)), dim=1)


class TransNetGraph(nn.Module):
    """`TransNet.forward` over 120 frames, of which a gap behind the first 60 is hidden.

    The tokens that answers are needed of come first; the last layer computes them alone.
    """

    def __init__(self, source: TransNet) -> None:
        super().__init__()
        order = torch.tensor(ORDER)
        pelvis = torch.tensor([c if c < 9 else c - WIDTH + PELVIS for c in ORDER[:PELVIS]])  # among the 12 columns
        rate_std, change_std = source.rate_std[order], source.change_std[order]
        means = source.pose_mean[order], source.seed_mean[pelvis]
        rates = (1.0 / std for std in (source.pose_std[order], source.seed_std[pelvis], rate_std))
        self.pose_mean, self.seed_mean = (constant(mean) for mean in means)
        self.pose_rate, self.seed_rate, self.rate = (constant(rate) for rate in rates)
        whole = [part * WIDTH + order for part in range(POSES + 1)]
        parts = [(POSES + 1) * WIDTH + part * PELVIS + pelvis for part in range(2)]
        columns = torch.cat((*whole, *parts, (POSES + 1) * WIDTH + 2 * PELVIS + torch.arange(TIME)))
        rows, scale = torch.cat((order, WIDTH + pelvis)), torch.cat((change_std, change_std[:PELVIS]))
        patch = source.body.patch
        self.early = (SEED - REACH) // patch * patch  # the first frame that is answered for
        times = torch.arange(WINDOW).roll(-self.early)
        self.body = Body(source.body, times, columns, GOAL, rows, scale, first=(WINDOW - self.early) // patch)
        self.smooth = constant(smoothed(torch.eye(WINDOW)[None])[0, SEED:, self.early :])
        self.gaps = Gaps()

    def forward(self, frames: Tensor, hidden: Tensor) -> Tensor:
        """(B, 120, 219), (B, 120) bool -> (B, 120, 219)."""
        gap = self.gaps(hidden[:, SEED:])
        seed, rest = ordered(frames[:, :SEED]), ordered(frames[:, SEED:].masked_fill(gap.there, 0.0))
        target = Standing.of(rest[:, -1:])
        seed, rest = seen(seed, target), seen(rest, target)
        around = torch.cat((seed[:, -2:], gap.behind @ rest), dim=1)
        line = torch.where(gap.there, gap.coasting @ around, rest)
        inputs = self._inputs(gap, seed, line, around[:, 2:3])
        body = Standing.of(seed[:, -1:])
        answer = self.smooth @ self.body(inputs, body.goal())
        change, pelvis = answer.split((WIDTH, PELVIS), dim=2)
        line, pelvis = line + change * gap.window, unseen(pelvis * gap.early, body.turn())
        line = joined(line[:, :, :PELVIS] + pelvis, line[:, :, PELVIS:])
        found = torch.where(gap.there, in_columns(unseen(line, target)), frames[:, SEED:])
        return torch.cat((frames[:, :SEED], found), dim=1)

    def _inputs(self, gap: Gap, seed: Tensor, line: Tensor, end: Tensor) -> Tensor:
        """What the network sees of every frame, those that are answered for first."""
        start, steps = seed[:, -1:], seed[:, 1:] - seed[:, :-1]
        rates = torch.where(gap.there, steps[:, -1:], (line - torch.cat((start, line[:, :-1]), dim=1)) * gap.known)
        body = Standing.of(start)
        poses = self._in_order(seed, line)
        rates = self._in_order(torch.cat((torch.zeros_like(start), steps), dim=1), rates)
        place = (seen(poses[:, :, :PELVIS], body) - self.seed_mean) * self.seed_rate
        turned = seen(rates[:, :, :PELVIS], body.turn()) * self.rate[:PELVIS]
        poses, start, end = ((frame - self.pose_mean) * self.pose_rate for frame in (poses, start, end))
        around = (self._in_gap(poses, torch.where(gap.there, row, self._rest(poses))) for row in (start, end))
        clock = nn.functional.pad(gap.clock, (0, 0, SEED - self.early, self.early))
        return joined(poses, *around, rates * self.rate, place, turned, clock)

    def _in_order(self, seed: Tensor, rest: Tensor) -> Tensor:
        return torch.cat((seed[:, self.early :], rest, seed[:, : self.early]), dim=1)

    def _rest(self, window: Tensor) -> Tensor:
        """Of a window in order, what is behind the seed."""
        return window[:, SEED - self.early : WINDOW - self.early]

    def _in_gap(self, window: Tensor, rest: Tensor) -> Tensor:
        """A window in order with something else behind the seed."""
        return torch.cat((window[:, : SEED - self.early], rest, window[:, WINDOW - self.early :]), dim=1)


def changes(length: int) -> Tensor:
    """The matrix (T, T) that takes every row's difference from the row before; the first row has that of the second."""
    steps = torch.eye(length) - torch.diag(torch.ones(length - 1), -1)
    steps[0] = steps[1]
    return steps
