"""Train TransNet: fill the gap between seed frames and a target pose, on every recording.

    python -m motionrt_training.recipes.transnet --corpus runs/recordings.npz --out runs/transnet --lr 1.2e-4

The gap grows from a few frames to the whole of frames 60..118. Windows in which something happens (a start, a stop, a
turn, a sit) are drawn more often than others. Some seeds stand still, and some targets are held, as anchor poses are.
Velocities count little and as squares: whole-hearted, their gradients (30 times those of places) drown all others.
The learning rate is low (1.2e-4) for the same reason; 3e-4 from the start learns nothing but the first average.
`--loss l2 --patch 1 --lr 1e-5` is how the paper trains.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import torch
from torch import Tensor, nn

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import ccf219
from motionrt.motion.features.ccf219 import FPS
from motionrt_training.corpora.recordings import Recordings, load_recordings
from motionrt_training.data_record import data_of
from motionrt_training.networks import kinematics
from motionrt_training.networks.kinematics import nearer_so3
from motionrt_training.networks.transnet import FRAMES, SEED, TransNet, turned_pelvis
from motionrt_training.networks.walknet import heading_turn, to_body
from motionrt_training.options import from_namespace, option, recipe_parser
from motionrt_training.trainer import Schedule, Trainer

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float32]

WARPS = (1.0, 0.8, 0.9, 1.12, 1.25)  # playback speeds; the first one is validated and gives the statistics
EARLIEST = 45  # first frame that is ever hidden
TAIL = 20  # most visible frames after the gap
CALM = 0.3  # m/s, mean over the joints: below this a pose may be taken for a held one
FEET = tuple(SMPL24.index(name) for name in ("left_ankle", "right_ankle", "left_foot", "right_foot"))
SLOW = 0.5  # m/s: errors of velocities below this count as squares
STANDING = (0.075, 0.075, 0.01, 0.01)  # heights of FEET in a standing pose, metres
ARMS = [SMPL24.index(f"{side}_{name}") for side in ("left", "right") for name in ("shoulder", "elbow", "wrist", "hand")]
LOSSES = ("joints", "l2")


@dataclass(frozen=True)
class TransNetSettings:
    """Network, data and loss."""

    d: int = option(512, "width")
    layers: int = option(3, "layers")
    heads: int = option(8, "attention heads")
    ff: int = option(1024, "feed-forward width")
    dropout: float = option(0.05, "dropout rate")
    patch: int = option(4, "frames per token (the paper: 1)")
    window: int = option(FRAMES, "frames M of a window, a multiple of --patch; what is shipped and run has 120")
    batch: int = option(24, "windows per batch")
    examples: int = option(1024, "windows that the statistics come from")
    grow: int = option(300, "steps in which the gap grows to frames 60..118")
    frozen: float = option(0.3, "part of the calm seeds that are made to stand still")
    held: float = option(0.5, "part of the visible calm ends that are made to stand still")
    tails: float = option(0.25, "part of the windows that show more of the end than the target")
    gaps: float = option(0.1, "part of the windows with a shorter gap elsewhere")
    arms: float = option(0.2, "part of the windows that take the arms of another")
    loss: str = option("joints", "joints: the terms below; l2: squares of the features alone, as published", LOSSES)
    place: float = option(6.0, "weight of the joints' places, metres")
    speed: float = option(0.2, "weight of the joints' velocities, m/s")
    feet: float = option(0.2, "weight of the speed of feet that stand, m/s")
    skate: float = option(0.03, "weight of the foot skate, cm per frame")
    skate_after: int = option(2226, "steps before the foot skate counts; where to go is learnt first")


class Windows(NamedTuple):
    """Frames of a split at several speeds, and where its windows begin."""

    frames: Floats  # (N, 219)
    calm: Floats  # (N,) mean speed of the joints, m/s
    starts: Ints  # (W,)
    odds: npt.NDArray[np.float64]  # (W,) cumulated
    length: int = FRAMES  # M, of a window

    def draw(self, rng: np.random.Generator, count: int) -> Ints:
        """First frames of random windows."""
        return self.starts[np.searchsorted(self.odds, rng.random(count) * self.odds[-1])]

    def at(self, starts: Ints) -> Tensor:
        """(B, M, 219) as recorded."""
        return torch.from_numpy(self.frames[starts[:, None] + np.arange(self.length)])


class TransNetTask:
    """The task of `Trainer`."""

    def __init__(self, recordings: Recordings, settings: TransNetSettings, seed: int) -> None:
        self.settings, self.seed = settings, seed
        if settings.window < SEED + TAIL or settings.window % settings.patch:
            raise InvalidInputError(
                f"--window must be a multiple of --patch, at least {SEED + TAIL}, not {settings.window}"
            )
        torch.manual_seed(seed)
        size = settings.d, settings.layers, settings.heads, settings.ff, settings.dropout, settings.patch
        self.model: TransNet = TransNet(*size)
        self.train = windows([motion for _, motion in recordings.split("train")], WARPS, settings.window)
        self.val = windows([motion for _, motion in recordings.split("val")], WARPS[:1], settings.window)
        set_statistics(self.model, *self._examples(self.train, np.random.default_rng(seed), settings.examples))

    def batch(self, step: int) -> dict[str, Tensor]:
        """Frames (B, M, 219) seen from the target and hidden (B, M)."""
        s, rng = self.settings, np.random.default_rng((self.seed, step))
        starts = self.train.draw(rng, s.batch)
        frames = mirrored(self.train.at(starts), rng.random(s.batch) < 0.5)
        frames = other_arms(frames, rng.random(s.batch) < s.arms, rng.permutation(s.batch))
        first, last = gaps(rng, s, min(1.0, (step + 1) / s.grow))
        frames = frozen_seed(frames, (self.train.calm[starts + SEED - 1] < CALM) & (rng.random(s.batch) < s.frozen))
        calm_end = self.train.calm[starts[:, None] + s.window - 1 - np.arange(TAIL)].max(1) < CALM
        frames = held_end(frames, last, calm_end & (rng.random(s.batch) < s.held))
        late = torch.tensor(float(step >= s.skate_after))
        return {"frames": to_body(frames)[0], "hidden": hidden_frames(first, last, s.window), "late": late}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """Features, places and velocities of the joints, sliding of standing feet."""
        net, s = self.model, self.settings
        found = model(batch["frames"], batch["hidden"])[:, EARLIEST - 1 :]
        truth, hidden = (batch[name][:, EARLIEST - 1 :] for name in ("frames", "hidden"))
        with torch.autocast(truth.device.type, enabled=False):
            weight = hidden.float() / hidden.sum(1, keepdim=True)  # (B, T)
            if s.loss == "l2":
                squares = _mean((found - truth).square().sum(2), weight)
                return {"loss": squares, "feature": squares}
            parts = {"feature": _mean(((found - truth) / net.change_std).abs().mean(2), weight)}
            joints, wanted = joint_positions(found), joint_positions(truth, rounds=0)
            parts["place"] = _mean(_length(joints - wanted).mean(2), weight)
            steps = (hidden[:, 1:] | hidden[:, :-1]).float()  # both seams are in it
            steps = steps / steps.sum(1, keepdim=True)
            rate, true_rate = (FPS * (x[:, 1:] - x[:, :-1]) for x in (joints, wanted))
            parts["speed"] = _mean(_huber(rate - true_rate).mean(2), steps)
            parts["feet"] = _mean(sliding(joints, wanted, rate, true_rate), steps)
            parts["skate"] = _mean(skate(joints), steps)
            weights = {"feature": 1.0, "place": s.place, "speed": s.speed, "feet": s.feet}
            weights["skate"] = s.skate * batch["late"]
            return {"loss": sum((weights[k] * v for k, v in parts.items()), torch.zeros(())), **parts}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Errors on held-out windows with the whole gap hidden; the score counts both errors."""
        pick = self.val.starts[:: max(1, len(self.val.starts) // 128)]
        frames = to_body(self.val.at(pick))[0]
        hidden = whole_gap(len(pick), self.settings.window)
        device = next(model.parameters()).device
        with torch.no_grad():
            found = model(frames.to(device), hidden.to(device)).cpu()
            wanted = joint_positions(frames, rounds=0)[:, SEED - 1 :]
            measures = errors(joint_positions(found, rounds=3)[:, SEED - 1 :], wanted)
        return {**measures, "score": -measures["joint_cm"] - 5.0 * measures["skate"]}

    def _examples(self, source: Windows, rng: np.random.Generator, count: int) -> tuple[Tensor, Tensor]:
        frames = mirrored(source.at(source.draw(rng, count)), rng.random(count) < 0.5)
        return to_body(frames)[0], whole_gap(count, source.length)


def windows(motions: Sequence[Motion], warps: Sequence[float], length: int = FRAMES) -> Windows:
    """Windows of ``length`` frames of all motions at all speeds.

    Calm beginnings and ends are held for a while, short clips are padded.

    Raises:
        InvalidInputError: no motion is long enough.
    """
    frames, calm, starts, odds, total = [], [], [], [], 0
    for warp in warps:
        for motion in motions:
            part, speed = _held(_at_speed(motion, warp), length)
            first = np.arange(len(part) - length + 1)
            if not len(first):
                continue
            frames.append(part)
            calm.append(speed)
            starts.append(first + total)
            odds.append(interest(part, first, length))
            total += len(part)
    if not frames:
        raise InvalidInputError(
            f"no recording of a split is {length} frames long; TransNet needs some in train and val"
        )
    odd = np.cumsum(np.concatenate(odds))
    return Windows(np.concatenate(frames), np.concatenate(calm), np.concatenate(starts), odd, length)


def interest(frames: Floats, first: Ints, length: int = FRAMES) -> Floats:
    """How often windows of (F, 219) should be drawn: (W,) by what changes in their gap."""
    a, m, b = (frames[first + k] for k in (SEED - 1, (SEED + length) // 2 - 1, length - 1))
    early, late = (np.linalg.norm((y - x)[:, [216, 218]], axis=1) for x, y in ((a, m), (m, b)))
    travel = np.linalg.norm((b - a)[:, [216, 218]], axis=1)
    height = np.abs(b - a)[:, 217] + np.abs(m - a)[:, 217]
    turn = np.linalg.norm((b - a)[:, [2, 8]], axis=1)  # of the pelvis' forward axis, 0 to 2
    pose = np.linalg.norm((b - a)[:, 9:216], axis=1) + np.linalg.norm((m - a)[:, 9:216], axis=1)
    walked = np.where(travel < 3.5, np.minimum(travel, 1.5), 0.5)
    started = np.abs(late - early)
    return np.minimum(0.1 + 0.5 * walked + started + turn + 3.0 * height + 0.1 * pose, 4.0).astype(np.float32)


def _at_speed(motion: Motion, warp: float) -> Motion:
    return dataclasses.replace(motion, fps=FPS * warp).resample(FPS)


def _held(motion: Motion, length: int = FRAMES) -> tuple[Floats, Floats]:
    """Features and speeds with the first pose held in front, the last one behind if it is calm."""
    steps = np.linalg.norm(np.diff(motion.positions(), axis=0), axis=2).mean(1) * FPS
    speed = np.append(steps, steps[-1]).astype(np.float32)
    before = SEED if speed[0] < CALM else max(0, min(SEED - 10, length - motion.frames))
    after = TAIL if speed[-1] < CALM else 0
    pad = ((before, after), (0, 0))
    return np.pad(ccf219.encode(motion), pad, mode="edge"), np.pad(speed, pad[0])


def gaps(rng: np.random.Generator, settings: TransNetSettings, grown: float) -> tuple[Ints, Ints]:
    """First hidden frame and the one after the last of every window; ``grown`` from 0 to 1."""
    count, whole = settings.batch, settings.window
    longest = max(4, round(grown * (whole - 1 - SEED)))
    first, last = np.full(count, SEED), np.full(count, SEED + longest)
    tail = rng.random(count) < settings.tails
    last = np.where(tail, np.maximum(last - rng.integers(1, TAIL, count), SEED + 4), last)
    short = rng.random(count) < settings.gaps
    length = rng.integers(4, longest + 1, count)
    elsewhere = rng.integers(EARLIEST, np.maximum(whole - length, EARLIEST + 1))
    first = np.where(short, elsewhere, first)
    return first, np.where(short, np.minimum(elsewhere + length, whole - 1), last)


def whole_gap(count: int, length: int) -> Tensor:
    """(B, M) bool: all frames between the seed and the target."""
    return hidden_frames(np.full(count, SEED), np.full(count, length - 1), length)


def hidden_frames(first: Ints, last: Ints, length: int = FRAMES) -> Tensor:
    """(B, M) bool."""
    time = np.arange(length)
    return torch.from_numpy((time >= first[:, None]) & (time < last[:, None]))


def mirrored(frames: Tensor, which: npt.NDArray[np.bool_]) -> Tensor:
    """Left and right exchanged in the chosen windows of (B, T, 219)."""
    sign = torch.tensor([-1.0, 1.0, 1.0])
    joints = frames[..., :216].unflatten(-1, (24, 3, 3))[..., list(SMPL24.mirrored_joints), :, :]
    swapped = torch.cat(((joints * torch.outer(sign, sign)).flatten(-3), frames[..., 216:] * sign), dim=-1)
    return torch.where(torch.from_numpy(which)[:, None, None], swapped, frames)


def other_arms(frames: Tensor, which: npt.NDArray[np.bool_], order: Ints) -> Tensor:
    """The arms of another window of the batch in the chosen ones."""
    columns = torch.tensor([9 * joint + k for joint in ARMS for k in range(9)])
    out = frames.clone()
    rows = torch.from_numpy(np.flatnonzero(which))
    out[rows[:, None], :, columns] = frames[torch.from_numpy(order)[rows][:, None], :, columns]
    return out


def frozen_seed(frames: Tensor, which: npt.NDArray[np.bool_]) -> Tensor:
    """Seeds of the chosen windows stand still in their last pose."""
    still = torch.cat((frames[:, SEED - 1 : SEED].expand(-1, SEED, -1), frames[:, SEED:]), dim=1)
    return torch.where(torch.from_numpy(which)[:, None, None], still, frames)


def held_end(frames: Tensor, last: Ints, which: npt.NDArray[np.bool_]) -> Tensor:
    """Frames from ``last`` on are the target in the chosen windows."""
    held = torch.from_numpy((np.arange(frames.shape[1]) >= last[:, None]) & which[:, None])
    return torch.where(held[..., None], frames[:, -1:], frames)


def joint_positions(features: Tensor, *, rounds: int = 1) -> Tensor:
    """(B, T, 219) -> (B, T, 24, 3) metres; predicted rotations are first drawn to SO(3) by Newton-Schulz steps."""
    rotations = features[..., :216].unflatten(-1, (24, 3, 3))
    if rounds:
        size = rotations.square().sum((-1, -2), keepdim=True)
        rotations = rotations * (3.0 / size.clamp(min=3.0)).sqrt()  # the steps need singular values up to sqrt(3)
    for _ in range(rounds):
        rotations = nearer_so3(rotations)
    return kinematics.joint_positions(rotations, features[..., 216:])


def sliding(joints: Tensor, wanted: Tensor, rate: Tensor, true_rate: Tensor) -> Tensor:
    """(B, T-1): speed of the feet where the true ones stand, and where the found ones are at the floor, m/s."""
    feet = list(FEET)
    still = (_length(true_rate[:, :, feet]) < 0.4) & (_height(wanted) < 0.05)
    low = (1.0 - _height(joints.detach()) / 0.03).clamp(0.0, 1.0)
    speed = _huber(rate[:, :, feet])
    return (speed * torch.maximum(still.float(), 0.5 * low)).mean(2)


def skate(joints: Tensor) -> Tensor:
    """(B, T-1): what every frame adds to the foot skate, cm  [Continual 4.3]; steps are rounded off below 1 mm."""
    toes = 100.0 * joints[:, :, list(FEET[2:])]
    step = ((toes[:, 1:] - toes[:, :-1])[..., [0, 2]].square().sum(-1) + 0.01).sqrt() - 0.1
    return (step * (2.0 - 0.8 * toes[:, 1:, :, 1].clamp(0.0, 2.5))).sum(2)


def errors(found: Tensor, wanted: Tensor) -> dict[str, float]:
    """Mean joint error and the same about the pelvis, centimetres; the foot skate, centimetres per frame."""
    local, true_local = found - found[..., :1, :], wanted - wanted[..., :1, :]
    return {
        "joint_cm": 100.0 * float(_length(found - wanted).mean()),
        "pose_cm": 100.0 * float(_length(local - true_local).mean()),
        "skate": float(skate(found).mean()),
    }


def set_statistics(net: TransNet, frames: Tensor, hidden: Tensor) -> None:
    """Means and deviations of what the network sees and has to give."""
    seed = frames[:, SEED - 1]
    place = seed[:, 216:] * seed.new_tensor([1.0, 0.0, 1.0])
    seen = turned_pelvis(frames, heading_turn(seed[:, :9]), place)
    line = net.line(frames, hidden)
    change = ((frames - line.frames) / line.window.clamp(min=0.3))[hidden]
    flat = frames.flatten(0, 1)
    net.pose_mean.copy_(flat.mean(0))
    net.pose_std.copy_(flat.std(0).clamp(min=0.02))
    net.rate_std.copy_((frames[:, 1:] - frames[:, :-1]).flatten(0, 1).std(0).clamp(min=0.002))
    net.seed_mean.copy_(seen.flatten(0, 1).mean(0))
    net.seed_std.copy_(seen.flatten(0, 1).std(0).clamp(min=0.02))
    net.change_std.copy_(change.std(0).clamp(min=0.02))


def _height(joints: Tensor) -> Tensor:
    return joints[:, :-1, list(FEET), 1] - joints.new_tensor(STANDING)


def _huber(rates: Tensor) -> Tensor:
    """Length of velocities that are large, and squares of small ones: jitter must not drown everything else."""
    return (rates.square().sum(-1) + SLOW * SLOW).sqrt() - SLOW


def _length(vectors: Tensor) -> Tensor:
    return (vectors.square().sum(-1) + 1e-8).sqrt()


def _mean(values: Tensor, weight: Tensor) -> Tensor:
    """Mean over windows of (B, T) values, whose weights sum to 1 per window."""
    return (values * weight).sum(1).mean()


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into ``args.out``; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(TransNetSettings, args)
    task = TransNetTask(load_recordings(args.corpus), settings, schedule.seed)
    notes = {**dataclasses.asdict(settings), "network": task.model.config}
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    return recipe_parser("Train TransNet.", Schedule, TransNetSettings)


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
