"""The task of WalkNet for `Trainer`: draw windows and goals, disturb the histories, compare the next second."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor

from motionrt_training.checkpoint import load_any
from motionrt_training.networks.kinematics import nearer_so3
from motionrt_training.networks.legs import feet
from motionrt_training.networks.walknet import FRAMES, WalkNet, seen_from, to_body, yawed
from motionrt_training.options import option
from motionrt_training.walk_pool import WalkPool
from motionrt_training.walk_trial import Trial

Ints = NDArray[np.int64]
Floats = NDArray[np.float32]

FOOT = 0.03  # metres and ...
PLACE = 0.05  # metres of the pelvis over the ground ...
STEP = 0.01  # ... metres per frame at which errors of the feet are large
UP = 3.0  # errors in height count this many times: the floor is near
DRIFT, DRIFTED = 0.1, 0.015  # steady error of the history: part of the standard deviation, and beyond it
STILL = 0.02  # standard deviation of a column below which it counts as one that never changes
JOINTS = slice(9, 216)  # columns of the joints below the pelvis
SHORTEST = FRAMES + 6  # frames of a stretch that are left at the first frame of a window
PLAIN = 0.8, 1.6  # m/s of somebody who walks straight ahead at an even pace


@dataclass(frozen=True)
class WalkSettings:
    """Network, data and loss."""

    width: int = option(512, "width of the network")
    ff: int = option(1024, "width of its feed-forward parts")
    patch: int = option(5, "frames that form one token; 1 is the paper's network")
    wishes: bool = option(True, "teach velocities, facings and speeds of arrival beside goals")
    stick: float = option(0.35, "part of the windows that hear of a velocity instead of a goal")
    faced: float = option(0.85, "part of those that hear of a facing, too")
    facing: float = option(0.3, "part of the others that do")
    arrival: float = option(0.5, "part of the others that hear of the speed to arrive with")
    cruise: float = option(0.5, "part of the others whose speed is the highest on the way, as of one who sets off")
    batch: int = option(128, "windows per batch")
    farthest: int = option(100, "frames from now to the farthest goal")
    fading: float = option(4.0, "frames in which an error of the history is to fade to a third")
    noise: float = option(1.0, "scale of the noise on the history")
    chain: int = option(4, "most predictions in a row before the one that is trained")
    chunk: int = option(8, "most frames kept of each")
    linear_beyond: float | None = option(3.0, "deviations beyond which errors count linearly; none for the paper's L2")
    chain_after: int = option(800, "steps before --chain begins")
    feet: float = option(0.02, "weight of the feet's positions and speeds")
    skate: float = option(0.05, "weight of the speed of planted toes")
    way: float = option(0.5, "weight of where the pelvis is over the ground: wishes are told there")
    plain: float = option(0.0, "part of the windows that are drawn from plain walks ahead alone")
    teacher: str | None = option(None, "trained weights whose plain walks ahead are to be kept; none has no teacher")


class WalkTask:
    """Windows of 30 frames and what follows, seen from a goal further on in the same stretch."""

    def __init__(self, train: WalkPool, val: WalkPool, settings: WalkSettings, seed: int) -> None:
        self.pool, self.settings, self.seed = train, settings, seed
        torch.manual_seed(seed)
        self.model = WalkNet(settings.width, ff=settings.ff, patch=settings.patch, wishes=settings.wishes)
        self.frames = torch.from_numpy(train.frames)
        self.planted = torch.from_numpy(train.planted)
        self.starts = train.starts(SHORTEST)
        weight = train.weight[self.starts].astype(np.float64)
        self.odds = np.cumsum(weight / weight.sum())
        now = self.starts + FRAMES - 1
        even = (train.weight[now] == 1.0) & (train.speed[now] > PLAIN[0]) & (train.speed[now] < PLAIN[1])
        self.plain = even & ~train.aside[now]
        self.teacher = load_any(Path(settings.teacher), WalkNet) if settings.teacher else None
        self._set_statistics()
        self.drifting = torch.ones(self.frames.shape[1])  # all columns but the place in the world, which is exact
        self.drifting[[216, 218]] = 0.0
        self.trial = Trial(val)

    def batch(self, step: int) -> dict[str, Tensor]:
        """Windows (B, 30 + chain + 30, 219) in their goals' frames; frames behind a stretch's end do not count."""
        rng = np.random.default_rng((self.seed, step))
        chosen = self._drawn(rng)
        first = self.starts[chosen]
        kept = self._chunks(rng, step)
        length = 2 * FRAMES + int(sum(kept))
        at = first[:, None] + np.arange(length)
        inside = at <= self.pool.last[first, None]
        at = np.minimum(at, self.pool.last[first, None])
        now = first + FRAMES - 1
        goal = (
            now
            + 1
            + (rng.random(len(now)) * np.minimum(self.settings.farthest, self.pool.last[first] - now)).astype(int)
        )
        heading = torch.from_numpy(self.pool.heading[goal])
        turn = torch.stack((heading.cos(), heading.sin()), dim=1)
        place = self.frames[goal, 216:] * torch.tensor([1.0, 0.0, 1.0])
        return {
            "window": seen_from(self.frames[at], turn, place),
            "inside": torch.from_numpy(inside),
            "planted": self.planted[at],
            "speed": torch.from_numpy(self._speeds(rng, now, goal)),
            "wish": self._wishes(rng, at[:, FRAMES - 1 : -FRAMES], goal, turn),
            "kept": torch.from_numpy(kept),
            "noise": torch.from_numpy(rng.random((len(first), 1, 1)).astype(np.float32)),
            "plain": torch.from_numpy(self.plain[chosen]),
        }

    def _drawn(self, rng: np.random.Generator) -> Ints:
        """(B,) which of the windows' starts are taken."""
        chosen = np.searchsorted(self.odds, rng.random(self.settings.batch)).clip(max=len(self.odds) - 1)
        if self.settings.plain and self.plain.any():
            even = rng.choice(np.flatnonzero(self.plain), len(chosen))
            chosen = np.where(rng.random(len(chosen)) < self.settings.plain, even, chosen)
        return chosen

    def _speeds(self, rng: np.random.Generator, now: Ints, goal: Ints) -> Floats:
        """(B,) m/s over the next second, or the highest on the way to the goal."""
        steps = now[:, None] + np.arange(0, self.settings.farthest + 1, 5)
        on_way = np.where(steps <= goal[:, None], self.pool.speed[np.minimum(steps, self.pool.last[now, None])], 0.0)
        highest = rng.random(len(now)) < self.settings.cruise * self.settings.wishes
        return np.where(highest, on_way.max(axis=1), self.pool.speed[now]).astype(np.float32)

    def _wishes(self, rng: np.random.Generator, at: Ints, goal: Ints, turn: Tensor) -> Tensor:
        """(B, chain + 1, 8) what is wished at every frame that the network is asked at, seen from the goal."""
        s, count = self.settings, len(at)
        stick = rng.random(count) < s.stick
        facing = np.where(stick, rng.random(count) < s.faced, rng.random(count) < s.facing) | self.pool.aside[at[:, 0]]
        arrival = ~stick & (rng.random(count) < s.arrival)
        velocity, faces = torch.from_numpy(self.pool.wish[at]).split(2, dim=2)  # (B, T, 2)
        flags = torch.from_numpy(np.stack([stick, facing, arrival], axis=1)).float()[:, None]  # (B, 1, 3)
        at_goal = torch.from_numpy(self.pool.pace[goal])[:, None, None].expand(-1, at.shape[1], 1)
        zero = torch.zeros_like(at_goal)
        vectors = torch.stack(
            (
                torch.cat((velocity[..., :1], zero, velocity[..., 1:]), 2),
                torch.cat((faces[..., :1], zero, faces[..., 1:]), 2),
            ),
            dim=3,
        )
        velocity, faces = yawed(vectors, turn * turn.new_tensor([1.0, -1.0]))[:, :, ::2].unbind(3)
        parts = (torch.ones_like(zero), velocity), (torch.ones_like(zero), faces), (torch.ones_like(zero), at_goal)
        wish = torch.cat([part * flags[..., k : k + 1] for k, pair in enumerate(parts) for part in pair], dim=2)
        return wish * float(s.wishes)

    def _chunks(self, rng: np.random.Generator, step: int) -> np.ndarray[Any, Any]:
        """How many frames of each of the predictions in a row before the trained one are kept."""
        if step < self.settings.chain_after:
            return np.zeros(0, dtype=np.int64)
        return rng.integers(1, self.settings.chunk + 1, int(rng.integers(self.settings.chain + 1)))

    def losses(self, model: torch.nn.Module, batch: Any) -> dict[str, Tensor]:
        """L2 of the next second, of its feet, and of the speed of planted toes."""
        net = cast("WalkNet", model)
        history, now = self._history(net, batch), FRAMES + int(batch["kept"].sum())
        wish = self._wish(batch, now)
        local, turn, place = to_body(history)
        true = seen_from(batch["window"][:, now - 1 : now + FRAMES], turn, place)
        target = true[:, 1:] + (local[:, -1:] - true[:, :1]) * self._fading(true)
        if self.teacher is not None and batch["plain"].any():
            target = self._taught(target, history, batch, turn, place)
        made = seen_from(net(history, batch["speed"], wish), turn, place)
        inside = batch["inside"][:, now : now + FRAMES].float() * self._weights(made)
        error = (
            soft_square((made - target) / net.change_std, self.settings.linear_beyond).mean(2) * inside
        ).sum() / inside.sum()
        planted = batch["planted"][:, now - 1 : now + FRAMES]
        paired = (planted[:, 1:] & planted[:, :-1]).float()
        footing = self._feet(local[:, -1:], made, target, inside, paired)
        within = batch["inside"][:, now : now + FRAMES].float()
        way = (robust((made - target)[..., [216, 218]] / PLACE) * within).sum() / within.sum()
        loss = error + self.settings.feet * footing["feet"] + self.settings.skate * footing["skate"]
        return {"loss": loss + self.settings.way * way, "features": error, "way": way, **footing}

    def _taught(self, target: Tensor, history: Tensor, batch: Any, turn: Tensor, place: Tensor) -> Tensor:
        """Targets (B, 30, 219), of plain walks ahead what the teacher makes of the same history."""
        plain, teacher = batch["plain"], cast("WalkNet", self.teacher).to(target.device)
        with torch.no_grad():
            made = teacher(history[plain], batch["speed"][plain])
        out = target.clone()
        out[plain] = seen_from(made, turn[plain], place[plain])
        return out

    def _history(self, net: WalkNet, batch: Any) -> Tensor:
        """The first frames with noise, followed by what the network itself made of them."""
        history = batch["window"][:, :FRAMES]
        white = torch.randn_like(history) * net.rate_std * 0.5
        steady = torch.randn_like(history[:, :1]) * (DRIFT * net.pose_std + DRIFTED) * self.drifting
        history = orthonormal(history + self.settings.noise * batch["noise"] * (white + steady))
        now = FRAMES
        with torch.no_grad():
            for kept in batch["kept"].tolist():
                made = net(history, batch["speed"], self._wish(batch, now))[:, :kept]
                now += kept
                history = torch.cat((history[:, kept:], orthonormal(made)), dim=1)
        return history

    def _wish(self, batch: Any, now: int) -> Tensor | None:
        """What is wished once `now` frames of the window are past."""
        return batch["wish"][:, now - FRAMES] if self.settings.wishes else None

    def _feet(self, last: Tensor, made: Tensor, target: Tensor, inside: Tensor, paired: Tensor) -> dict[str, Tensor]:
        points, true = feet(torch.cat((last, made), dim=1)), feet(torch.cat((last, target), dim=1))
        moved, truly = points.diff(dim=1), true.diff(dim=1)
        tall = made.new_tensor([1.0, UP, 1.0])
        place = robust((points - true)[:, 1:] * tall / FOOT).mean((2, 3))
        speed = robust((moved - truly)[:, 1:] / STEP).mean((2, 3))  # of the first frame the planted toes decide
        slip = robust(moved[..., 1, :] / STEP) * paired  # (B, 30, 2) of the toes
        total = inside.sum()
        followed = ((place * inside).sum() + (speed * inside[:, 1:]).sum()) / total
        return {"feet": followed, "skate": (slip.mean(2) * inside).sum() / total}

    def _fading(self, like: Tensor) -> Tensor:
        """(30, 1): what is left of an error of the history; it is to fade, not to be snapped back from."""
        return torch.exp(-(1.0 + torch.arange(FRAMES, device=like.device)) / self.settings.fading)[:, None]

    def _weights(self, like: Tensor) -> Tensor:
        """(30,): only the first frame is kept at run time, so it counts most."""
        return 1.0 / (1.0 + torch.arange(FRAMES, device=like.device) * 0.2)

    def validate(self, model: torch.nn.Module) -> dict[str, float]:
        """Walks along paths with turns, at stride 1, by the averaged weights."""
        return self.trial.measures(cast("WalkNet", model))

    def _set_statistics(self) -> None:
        """Means and deviations of the network's inputs and outputs, from a sample of windows."""
        rng = np.random.default_rng(0)
        first = rng.choice(self.pool.starts(2 * FRAMES), 4000)
        window = self.frames[torch.from_numpy(first[:, None] + np.arange(2 * FRAMES))]
        local, turn, place = to_body(window[:, :FRAMES])
        future = seen_from(window[:, FRAMES:], turn, place)
        net = self.model
        net.pose_mean.copy_(local.mean((0, 1)))
        spread = local.std((0, 1))
        net.pose_std.copy_(spread.clamp(min=0.01))
        net.still[JOINTS] = (spread < STILL).float()[JOINTS]
        net.rate_std.copy_(local.diff(dim=1).std((0, 1)).clamp(min=0.001))
        change = (future - local[:, -1:]).std(0)
        net.change_std.copy_(torch.maximum(change, 0.03 * net.pose_std).clamp(min=0.001))


def soft_square(error: Tensor, linear_beyond: float | None = 3.0) -> Tensor:
    """Squared errors, linear beyond a few standard deviations: (30, 219) of them are rarely all well behaved."""
    if linear_beyond is None:
        return error.square()
    return 2.0 * F.huber_loss(error, torch.zeros_like(error), reduction="none", delta=linear_beyond)


def robust(error: Tensor) -> Tensor:
    """Length of vectors (..., 3), squared where small, linear where large."""
    return (1.0 + error.square().sum(-1)).sqrt() - 1.0


def orthonormal(frames: Tensor) -> Tensor:
    """(B, T, 219) with rotations brought near to SO(3): one Newton step of the polar decomposition."""
    matrices = nearer_so3(frames[..., :216].unflatten(-1, (24, 3, 3)))
    return torch.cat((matrices.flatten(-3), frames[..., 216:]), dim=-1)
