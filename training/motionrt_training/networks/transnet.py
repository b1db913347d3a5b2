"""TransNet: the motion between some seed frames and a target pose  [Continual 3.6].

Frames stand in the target's frame, as in the paper. Hidden frames are first filled by coasting: everything leaves the
last visible frame with the speed that it has there, soon moves evenly, and arrives at the next one. The transformer
corrects that. The correction fades towards visible frames, which themselves come back as they were, so that a
transition begins and ends where it should. Part of the correction of the pelvis is given in the heading of the last
frame before the gap: a step then looks the same whichever way it leads.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn

from motionrt.motion.features.ccf219 import WIDTH
from motionrt_training.networks.motion_transformer import MotionTransformer
from motionrt_training.networks.walknet import from_body, goal_features, heading_turn, to_body, yawed

FRAMES = 120  # M
SEED = 60  # visible frames at the start
PELVIS = 12  # columns that change with the frame: 9 of the pelvis' rotation, 3 of the root
TIME = 8  # columns of `Gap.clock`
GOAL = 7
COAST = 5.0  # frames in which the speed before or behind a gap is forgotten ...
COAST_SHARE = 0.2  # ... or this part of a shorter gap
FADE = 5.0  # frames: how fast the correction grows with the distance from visible frames
FAR = 30.0  # frames: scale of the clock


class Gap(NamedTuple):
    """Where the frames around each frame are; all (B, T), index of time."""

    before: Tensor  # the last visible frame up to here
    after: Tensor  # the first visible frame from here
    last_seed: Tensor  # (B,) the frame before the first hidden one


class Line(NamedTuple):
    """What the network sees, and what its answer is added to; everything seen from the target."""

    frames: Tensor  # (B, T, 219), hidden ones filled by coasting
    turn: Tensor  # (B, 2) and (B, 3): heading and place of the target in the frame of the caller
    place: Tensor
    seed_turn: Tensor  # (B, 2) and (B, 3): of the last frame before the gap, seen from the target
    seed_place: Tensor
    window: Tensor  # (B, T, 1), 0 at visible frames
    share: Tensor  # (B, T, 1) from 0 at the seed to 1 at the target
    inputs: Tensor  # (B, T, in_dim)


class TransNet(nn.Module):
    """(B, 120, 219) `ccf219` in the target's frame and which frames are hidden -> all frames (B, 120, 219).

    ``patch`` consecutive frames form one token; 1 is the paper's network.
    """

    pose_mean: Tensor  # (219,) of frames seen from the target
    pose_std: Tensor
    rate_std: Tensor  # (219,) of changes between neighbours
    seed_mean: Tensor  # (12,) of the pelvis seen from the last seed frame
    seed_std: Tensor
    change_std: Tensor  # (219,) of the wanted correction, before it fades

    def __init__(
        self, d: int = 512, layers: int = 3, heads: int = 8, ff: int = 1024, dropout: float = 0.0, patch: int = 4
    ) -> None:
        super().__init__()
        self.config = {"d": d, "layers": layers, "heads": heads, "ff": ff, "dropout": dropout, "patch": patch}
        columns = 4 * WIDTH + 2 * PELVIS + TIME + GOAL
        self.body = MotionTransformer(columns, WIDTH + PELVIS, d, layers, heads, ff, dropout, patch)
        for name, width in (("pose", WIDTH), ("rate", WIDTH), ("seed", PELVIS), ("change", WIDTH)):
            self.register_buffer(f"{name}_std", torch.ones(width))
        self.register_buffer("pose_mean", torch.zeros(WIDTH))
        self.register_buffer("seed_mean", torch.zeros(PELVIS))
        nn.init.zeros_(self.body.out.weight)  # an untrained network coasts

    def forward(self, frames: Tensor, hidden: Tensor) -> Tensor:
        """Frames (B, 120, 219), hidden (B, 120) bool -> (B, 120, 219); what is hidden in `frames` is not read."""
        line = self.line(frames, hidden)
        found = self.corrected(line, self.body(line.inputs))
        return torch.where(hidden[..., None], from_body(found, line.turn, line.place), frames)

    def line(self, frames: Tensor, hidden: Tensor) -> Line:
        """Fill the gap, turn everything to the target and normalise."""
        gap = find_gap(hidden)
        frames, turn, place = to_body(fill(frames.masked_fill(hidden[..., None], 0.0), gap))
        seed = frames.gather(1, gap.last_seed[:, None, None].expand(-1, 1, WIDTH))[:, 0]  # (B, 219)
        seed_turn, seed_place = heading_turn(seed), seed[:, 216:] * seed.new_tensor([1.0, 0.0, 1.0])
        from_start, to_end = _distances(gap, hidden)
        share = from_start / (from_start + to_end).clamp(min=1.0)
        window = (1.0 - torch.exp(-from_start / FADE)) * (1.0 - torch.exp(-to_end / FADE))
        goal = goal_features(seed_turn, seed_place)[:, None].expand(-1, frames.shape[1], -1)
        rates = _rates(frames, hidden, gap.before)
        poses = (frames, frames_at(frames, gap.before), frames_at(frames, gap.after))
        parts = (
            *((pose - self.pose_mean) / self.pose_std for pose in poses),
            rates / self.rate_std,
            (turned_pelvis(frames, seed_turn, seed_place) - self.seed_mean) / self.seed_std,
            turned_pelvis(rates, seed_turn, torch.zeros_like(seed_place)) / self.rate_std[_PELVIS],
            clock(hidden, from_start, to_end),
            goal,
        )
        inputs = torch.cat(parts, dim=2)
        return Line(frames, turn, place, seed_turn, seed_place, window[..., None], share[..., None], inputs)

    def corrected(self, line: Line, answer: Tensor) -> Tensor:
        """The filled frames with the correction that the network gave: (B, T, 231) -> (B, T, 219)."""
        answer = smoothed(answer.float())
        change = answer[..., :WIDTH] * self.change_std * line.window
        pelvis = answer[..., WIDTH:] * self.change_std[_PELVIS] * (line.window * (1.0 - line.share))
        turned = yawed(pelvis[..., :9].unflatten(-1, (3, 3)), line.seed_turn).flatten(2)
        rest = torch.zeros_like(change[..., 9:216])
        return line.frames + change + torch.cat((turned, rest, yawed(pelvis[..., 9:], line.seed_turn)), dim=2)


_PELVIS = [*range(9), *range(216, 219)]


def find_gap(hidden: Tensor) -> Gap:
    """Neighbours of every frame of `hidden` (B, T) bool; frames without a visible one on a side take the other's."""
    length = hidden.shape[1]
    time = torch.arange(length, device=hidden.device)
    seen = (~hidden)[:, None, :]  # (B, 1, T)
    earlier = time[None, :] <= time[:, None]  # (T, T)
    before = torch.where(seen & earlier, time, -1).amax(2)
    after = torch.where(seen & earlier.transpose(0, 1), time, length).amin(2)
    first = torch.where(hidden, time, length).amin(1)
    both = torch.where(before < 0, after, before), torch.where(after >= length, before, after)
    return Gap(both[0].clamp(0, length - 1), both[1].clamp(0, length - 1), (first - 1).clamp(0, length - 1))


def fill(frames: Tensor, gap: Gap) -> Tensor:
    """Every column coasts through the gaps; visible frames stay.

    Over a gap of L frames, t frames in: x = x0 + a t + (v - a) f(t) + (w - a) (f(L) - f(L - t)) with
    f(t) = c (1 - e^(-t/c)),
    the changes per frame v before and w behind the gap, and a so that the end is met. Where v or w is not to be
    seen (behind a single target), its term is left out.
    """
    start, end = frames_at(frames, gap.before), frames_at(frames, gap.after)
    v, v_seen = _change(frames, gap, gap.before - 1, gap.before)
    w, w_seen = _change(frames, gap, gap.after, gap.after + 1)
    time = torch.arange(frames.shape[1], device=frames.device)
    length = (gap.after - gap.before).clamp(min=1).to(frames.dtype)[..., None]
    passed = (time - gap.before).clamp(min=0).to(frames.dtype)[..., None]
    scale = (COAST_SHARE * length).clamp(max=COAST)
    whole = scale * (1.0 - torch.exp(-length / scale))
    early = v_seen * scale * (1.0 - torch.exp(-passed / scale))
    late = w_seen * (whole - scale * (1.0 - torch.exp((passed - length) / scale)))
    even = (end - start - (v * v_seen + w * w_seen) * whole) / (length - (v_seen + w_seen) * whole)
    inside = (gap.after > gap.before)[..., None].to(frames.dtype)
    return start + inside * (even * passed + (v - even) * early + (w - even) * late)


def frames_at(frames: Tensor, index: Tensor) -> Tensor:
    """Frames (B, T, D) in the order of `index` (B, T)."""
    return frames.gather(1, index[..., None].expand(-1, -1, frames.shape[2]))


def _change(frames: Tensor, gap: Gap, first: Tensor, second: Tensor) -> tuple[Tensor, Tensor]:
    """Change from frame `first` to frame `second`, and 1 where both are visible, else 0: (B, T, D), (B, T, 1)."""
    last = frames.shape[1] - 1
    there = (first >= 0) & (second <= last)
    first, second = first.clamp(0, last), second.clamp(0, last)
    seen = there & (gap.before.gather(1, first) == first) & (gap.before.gather(1, second) == second)
    return frames_at(frames, second) - frames_at(frames, first), seen[..., None].to(frames.dtype)


def smoothed(answer: Tensor) -> Tensor:
    """Binomial mean over five frames of (B, T, D): no jitter between frames; sums of slices, so float32 always."""
    length = answer.shape[1]
    x = torch.cat((answer[:, :1], answer[:, :1], answer, answer[:, -1:], answer[:, -1:]), dim=1)
    return sum((w / 16.0 * x[:, k : k + length] for k, w in enumerate((1.0, 4.0, 6.0, 4.0))), x[:, 4:] / 16.0)


def clock(hidden: Tensor, from_start: Tensor, to_end: Tensor) -> Tensor:
    """(B, T, 8): is it hidden, how far are the ends of the gap, on three scales, and how long is it."""
    scales = [distance / (distance + scale) for distance in (from_start, to_end) for scale in (2.0, 10.0, FAR)]
    return torch.stack((hidden.float(), *scales, (from_start + to_end) / (2 * FAR)), dim=2)


def turned_pelvis(frames: Tensor, turn: Tensor, place: Tensor) -> Tensor:
    """The 12 columns of pelvis and root of (B, T, 219), seen from a body at `place` (B, 3) with `turn` (B, 2)."""
    back = turn * turn.new_tensor([1.0, -1.0])
    pelvis = yawed(frames[..., :9].unflatten(-1, (3, 3)), back).flatten(2)
    return torch.cat((pelvis, yawed(frames[..., 216:] - place[:, None], back)), dim=2)


def _distances(gap: Gap, hidden: Tensor) -> tuple[Tensor, Tensor]:
    """Frames since the last visible one and to the next, (B, T) each."""
    time = torch.arange(hidden.shape[1], device=hidden.device)
    return (time - gap.before).abs().float(), (gap.after - time).abs().float()


def _rates(frames: Tensor, hidden: Tensor, before: Tensor) -> Tensor:
    """Change since the frame before, where both are visible; hidden frames take that of the last visible one."""
    known = ~(hidden[:, 1:] | hidden[:, :-1])
    rates = (frames[:, 1:] - frames[:, :-1]) * known[..., None].to(frames.dtype)
    rates = torch.cat((torch.zeros_like(rates[:, :1]), rates), dim=1)
    return frames_at(rates, before)
