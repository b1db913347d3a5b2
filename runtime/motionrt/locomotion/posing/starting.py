"""Where a search begins: typical poses, each put where its joints come nearest to the keypoints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.locomotion.posing.body import Bodies, Prior, Rows, turned
from motionrt.locomotion.posing.objective import Objective, Weights
from motionrt.locomotion.posing.targets import Targets

COARSE = Weights(reach=0.08, ground=0.08, stand=0.08, balance=0.20, heading=0.15, prior=0.3)


@dataclass(frozen=True, eq=False)
class Start:
    """A latent ``(latent,)``, a root ``(3,)`` and a yaw."""

    latent: Rows
    root: Rows
    yaw: float

    def vector(self) -> Rows:
        """The unknowns of the search in one vector: latent, root, yaw."""
        return np.concatenate([self.latent, self.root, [self.yaw]])


def best_starts(prior: Prior, targets: Targets, count: int) -> list[Start]:
    """The ``count`` starts of lowest cost, best first."""
    candidates = Bodies(*(part.astype(np.float64) for part in prior.starts))
    yaw = fitted_yaw(candidates, targets)
    root = fitted_root(candidates, targets, yaw)
    cost = np.square(Objective(targets, COARSE).rows(candidates.latents, candidates.placed(root, yaw), yaw)).sum(axis=1)
    order = np.argsort(cost)[:count]
    return [Start(candidates.latents[i], root[i], float(yaw[i])) for i in order]


def fitted_yaw(candidates: Bodies, targets: Targets) -> Rows:
    """The yaw ``(B,)`` that brings the joints nearest to the keypoints about their common middle; or the heading."""
    if targets.heading is not None:
        return np.full(len(candidates.latents), targets.heading)
    own = candidates.positions[:, list(targets.joints)]
    own = own - own.mean(axis=1, keepdims=True)
    wanted = targets.points - targets.points.mean(axis=0)
    across = (own[..., 2] * wanted[:, 0] - own[..., 0] * wanted[:, 2]).sum(axis=1)
    along = (own[..., 0] * wanted[:, 0] + own[..., 2] * wanted[:, 2]).sum(axis=1)
    return np.asarray(np.arctan2(across, along))


def fitted_root(candidates: Bodies, targets: Targets, yaw: Rows) -> Rows:
    """The root ``(B, 3)`` at which the middle of the joints is the middle of the keypoints."""
    own = turned(candidates.positions[:, list(targets.joints)], yaw)
    return np.asarray((targets.points - own).mean(axis=1))
