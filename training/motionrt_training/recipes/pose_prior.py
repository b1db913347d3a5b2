"""Train the pose prior on packed recordings.

    python -m motionrt_training.recipes.pose_prior --corpus runs/recordings.npz --out runs/pose_prior --minutes 10

Most recorded poses are steps of a walk. Poses are therefore clustered by their joints' positions, and a cluster is
drawn with the power ``--balance`` of its size: 1 is the corpus as it is, 0 draws all kinds of pose alike.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor

from motionrt.locomotion.posing.yaw import without_yaw
from motionrt.motion import SMPL24
from motionrt_training.corpora.recordings import Recordings, load_recordings
from motionrt_training.data_record import data_of
from motionrt_training.networks.kinematics import joint_positions
from motionrt_training.networks.pose_prior import PosePrior, to_6d
from motionrt_training.options import from_namespace, option, recipe_parser
from motionrt_training.trainer import Losses, Schedule, Trainer

UPRIGHT = 0.2  # least height of the pelvis' up axis; below it a body is upside down or lies on its side
_MIRROR = torch.tensor([1.0, -1.0, -1.0, -1.0, 1.0, 1.0, -1.0, 1.0, 1.0]).view(
    3, 3
)  # signs of M R M, M = diag(-1, 1, 1)


@dataclass(frozen=True)
class PosePriorSettings:
    """Network, data and losses."""

    latent: int = option(32, "size of the latent")
    width: int = option(512, "width of the hidden layers")
    dropout: float = option(0.1, "dropout rate of the encoder")
    batch: int = option(512, "poses per batch")
    every: int = option(2, "frames at 30 fps of which one is taken")
    clusters: int = option(400, "kinds of pose that are balanced")
    balance: float = option(0.4, "power of a cluster's size that it is drawn with")
    noise: float = option(0.02, "noise on the 6D rotations that the encoder sees")
    position_weight: float = option(20.0, "weight of the mean distance of the joints, metres")
    rotation_weight: float = option(1.0, "weight of the mean squared difference of the rotation matrices")
    kl_weight: float = option(3e-3, "weight of the divergence from N(0, 1), nats")


class PosePriorTask:
    """The task of `Trainer`: autoencode balanced poses and their mirror images."""

    def __init__(self, corpus: Recordings, settings: PosePriorSettings, seed: int) -> None:
        self.settings, self.seed = settings, seed
        self.poses, self.held_out = (poses_of(corpus, split, settings.every) for split in ("train", "val"))
        self.chances = np.cumsum(pose_weights(self.poses, settings.clusters, settings.balance, seed))
        torch.manual_seed(seed)
        self.model = PosePrior(settings.latent, settings.width, settings.dropout)
        self._set_statistics()

    def batch(self, step: int) -> Tensor:
        """Rotations (B, 24, 3, 3); half of them mirrored."""
        rng = np.random.default_rng((self.seed, step))
        pick = np.searchsorted(self.chances, rng.random(self.settings.batch) * self.chances[-1])
        poses = self.poses[torch.from_numpy(np.minimum(pick, len(self.poses) - 1))]
        half = torch.from_numpy(rng.random(len(poses)) < 0.5)
        return torch.where(half[:, None, None, None], mirrored(poses), poses)

    def losses(self, model: PosePrior, batch: Any) -> Losses:
        """Distances of joints, differences of rotations, divergence from the prior."""
        mu, logvar = model.encode(batch + self.settings.noise * torch.randn_like(batch))
        mu, logvar = mu.float(), logvar.float()
        made = model.decode(mu + (0.5 * logvar).exp() * torch.randn_like(mu)).float()
        position = joint_distances(made, batch).mean()
        rotation = (made - batch).square().sum((-1, -2)).mean()
        kl = 0.5 * (mu.square() + logvar.exp() - 1.0 - logvar).sum(-1).mean()
        s = self.settings
        loss = s.position_weight * position + s.rotation_weight * rotation + s.kl_weight * kl
        return {"loss": loss, "position": position, "rotation": rotation, "kl": kl}

    def validate(self, model: PosePrior) -> dict[str, float]:
        """Mean joint error of held-out poses and of their rare tenth, centimetres; how normal the latents are."""
        mu, logvar = model.encode(self.held_out)
        errors = joint_distances(model.decode(mu), self.held_out).mean(-1) * 100.0
        rare = errors.topk(max(1, len(errors) // 10)).values
        spread = (mu.var(0) + logvar.exp().mean(0)).sqrt()  # 1 in a latent that is N(0, 1) as a whole
        measures = {"error_cm": errors.mean(), "worst_tenth_cm": rare.mean(), "spread": spread.mean()}
        active = (mu.std(0) > 0.1).float().sum()
        return {name: float(value) for name, value in measures.items()} | {
            "active": float(active),
            "score": -float(errors.mean()),
        }

    def _set_statistics(self) -> None:
        """Mean and deviation of the 6D rotations of 20,000 balanced poses."""
        rows = torch.cat([to_6d(self.batch(step)).flatten(1) for step in range(20000 // self.settings.batch + 1)])
        self.model.mean.copy_(rows.mean(0))
        self.model.std.copy_(rows.std(0).clamp(min=0.02))


def joint_distances(made: Tensor, wanted: Tensor) -> Tensor:
    """Distances (B, 24) of the joints of two batches of rotations, pelvis on pelvis, metres."""
    return (joint_positions(made) - joint_positions(wanted)).square().sum(-1).add(1e-10).sqrt()


def poses_of(corpus: Recordings, split: str, every: int = 1) -> Tensor:
    """Rotations (N, 24, 3, 3) of every `every`-th frame of a split, pelvis without yaw; none upside down."""
    parts = []
    for _, motion in corpus.split(split):
        rotations = motion.rotations[::every].copy()
        rotations[:, 0] = without_yaw(rotations[:, 0])
        parts.append(rotations[rotations[:, 0, 1, 1] > UPRIGHT])
    return torch.from_numpy(np.concatenate(parts))


def mirrored(rotations: Tensor) -> Tensor:
    """The mirror image of poses (B, 24, 3, 3): left and right exchanged."""
    return rotations[:, list(SMPL24.mirrored_joints)] * _MIRROR


def pose_weights(poses: Tensor, clusters: int, balance: float, seed: int, sweeps: int = 8) -> np.ndarray:
    """Weights (N,) float64 by which a cluster of n poses is drawn n^balance times as often as one of a single pose."""
    points = torch.cat([joint_positions(part).flatten(1) for part in poses.split(4096)])
    member = k_means(points, min(clusters, len(points)), seed, sweeps)
    sizes = torch.bincount(member, minlength=clusters).double()
    weights = sizes[member] ** (balance - 1.0)
    return (weights / weights.sum()).numpy()


def k_means(points: Tensor, clusters: int, seed: int, sweeps: int) -> Tensor:
    """The cluster (N,) of every point (N, D): Lloyd's algorithm from random points."""
    generator = torch.Generator().manual_seed(seed)
    centres = points[torch.randperm(len(points), generator=generator)[:clusters]]
    for _ in range(sweeps):
        member = nearest(points, centres)
        sums = torch.zeros_like(centres).index_add_(0, member, points)
        counts = torch.bincount(member, minlength=clusters)[:, None]
        centres = torch.where(counts > 0, sums / counts.clamp(min=1), centres)
    return nearest(points, centres)


def nearest(points: Tensor, centres: Tensor) -> Tensor:
    """The nearest centre (N,) of every point."""
    return torch.cat([torch.cdist(part, centres).argmin(1) for part in points.split(8192)])


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into ``args.out``; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(PosePriorSettings, args)
    torch.set_num_threads(schedule.threads or torch.get_num_threads())
    task = PosePriorTask(load_recordings(args.corpus), settings, schedule.seed)
    notes = {**dataclasses.asdict(settings), "network": task.model.config}
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = recipe_parser("Train the pose prior.", Schedule, PosePriorSettings)
    result.set_defaults(steps=60000, lr=1e-3, validate_every=500, log_every=100)
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
