"""The search for the latent, the root and the yaw: Levenberg-Marquardt on the residuals of the objective."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.locomotion.posing.body import Prior, Rows, positions, turned
from motionrt.locomotion.posing.damped import least_squares
from motionrt.locomotion.posing.objective import Objective
from motionrt.locomotion.posing.starting import Start

STEP = 0.01  # of a latent, for the finite differences: large against float32 noise, small against the decoder's bends
SHIFT = 1e-4  # of the root (metres) and the yaw (radians)
PLACE = 4  # unknowns that say where the body is: root and yaw


@dataclass(frozen=True, eq=False)
class Found:
    """Where a search ended."""

    latent: Rows
    root: Rows
    yaw: float
    cost: float
    iterations: int


class Search:
    """Residuals and their Jacobian in one decoding of ``1 + latent`` rows."""

    def __init__(self, prior: Prior, objective: Objective) -> None:
        self.prior, self.objective, self.size = prior, objective, prior.latent
        steps = np.concatenate([np.full(self.size, STEP), np.full(PLACE, SHIFT)])
        self._moves = np.concatenate([np.zeros((1, len(steps))), np.diag(steps)])
        self._rates = 1 / steps

    def residuals(self, x: Rows) -> tuple[Rows, Rows]:
        """Residuals ``(M,)`` of the unknowns ``(latent + 4,)``, and their derivatives ``(M, latent + 4)``."""
        moved = x + self._moves
        latents, root, yaw = moved[:, : self.size], moved[:, self.size : -1], moved[:, -1]
        decoded = 1 + self.size  # root and yaw move the first body: no decoding needed
        found = positions(self.prior.decode(latents[:decoded]))
        found = np.concatenate([found, np.broadcast_to(found[:1], (PLACE, *found.shape[1:]))])
        rows = self.objective.rows(latents, turned(found, yaw) + root[:, None], yaw)
        return rows[0], (rows[1:] - rows[0]).T * self._rates

    def run(self, start: Start, evaluations: int) -> Found:
        """The optimum that the search reaches from ``start``."""
        x, cost, count = least_squares(self.residuals, start.vector(), evaluations)
        return Found(x[: self.size], x[self.size : -1], float(x[-1]), cost, count)
