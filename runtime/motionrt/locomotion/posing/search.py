"""The search for the latent, the root and the yaw: Levenberg-Marquardt on the residuals of the objective."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.locomotion.posing.body import Bodies, Prior, Rows, bodies
from motionrt.locomotion.posing.objective import Objective
from motionrt.locomotion.posing.starting import Start

STEP = 0.01  # of a latent, for the finite differences: large against float32 noise, small against the decoder's bends
SHIFT = 1e-4  # of the root (metres) and the yaw (radians)


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
        self._steps = np.concatenate([np.zeros((1, self.size)), STEP * np.eye(self.size)])
        self._at: Rows | None = None
        self._jacobian: Rows = np.empty((0, 0))

    def residuals(self, x: Rows) -> Rows:
        """Residuals ``(M,)`` of the unknowns ``(latent + 4,)``; keeps what :meth:`jacobian` needs."""
        rows, self._jacobian = self._both(x)
        self._at = x.copy()
        return rows

    def jacobian(self, x: Rows) -> Rows:
        """Derivatives ``(M, latent + 4)`` of :meth:`residuals`."""
        if self._at is None or not np.array_equal(x, self._at):
            self.residuals(x)
        return self._jacobian

    def run(self, start: Start, evaluations: int) -> Found:
        """The optimum that the search reaches from ``start``."""
        from scipy.optimize import least_squares

        result = least_squares(
            self.residuals,
            start.vector(),
            jac=self.jacobian,
            method="lm",
            ftol=1e-3,
            xtol=1e-3,
            gtol=1e-6,
            max_nfev=evaluations,
        )
        x = result.x
        return Found(x[: self.size], x[self.size : -1], float(x[-1]), float(result.cost), int(result.nfev))

    def _both(self, x: Rows) -> tuple[Rows, Rows]:
        latents = x[: self.size] + self._steps
        decoded = bodies(latents, self.prior.decode(latents))
        rows = self._rows(decoded, x[None, self.size : -1], x[-1:])
        by_latent = (rows[1:] - rows[0]) / STEP
        return rows[0], np.concatenate([by_latent, self._by_place(decoded, x, rows[0])]).T

    def _by_place(self, decoded: Bodies, x: Rows, rows: Rows) -> Rows:
        """Derivatives by root and yaw ``(4, M)``: no decoding needed."""
        moved = x[None, self.size :] + SHIFT * np.eye(4)
        same = Bodies(np.repeat(decoded.latents[:1], 4, axis=0), np.repeat(decoded.positions[:1], 4, axis=0))
        return (self._rows(same, moved[:, :3], moved[:, 3]) - rows) / SHIFT

    def _rows(self, decoded: Bodies, root: Rows, yaw: Rows) -> Rows:
        count = len(decoded.latents)
        turns = np.broadcast_to(yaw, (count,))
        return self.objective.rows(decoded.latents, decoded.placed(root, turns), turns)
