"""Least squares of a few dozen unknowns: Levenberg-Marquardt, whose every evaluation gives the derivatives, too.

``scipy.optimize`` would do as well, but takes a third of a second to import, and another evaluation or two.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Rows = npt.NDArray[np.float64]
Residuals = Callable[[Rows], tuple[Rows, Rows]]
"""Unknowns (N,) -> residuals (M,) and their derivatives (M, N)."""

_LEAST_SHARE = 1 / 3  # of the damping that a step leaves of it that came out as predicted
_MOST = 1e12  # damping at which no step is left


class Minimum(NamedTuple):
    """Where the search ended: the unknowns, half the sum of squares there, and how many evaluations it took."""

    x: Rows
    cost: float
    evaluations: int


def least_squares(
    residuals: Residuals, x: Rows, evaluations: int, *, damping: float = 10.0, close: float = 1e-3
) -> Minimum:
    """The nearest minimum of half the sum of squares, from ``x`` on.

    The damping follows the gain of every step (Nielsen 1999). The search is over when a step promises less than the
    share ``close`` of the cost; that step is still taken, and its cost predicted.

    Args:
        residuals: with their derivatives; unknowns that count alike have the same scale.
        x: ``(N,)`` where to begin.
        evaluations: the most that are made, 1 or more.
        damping: of the first step, added to the squares of the derivatives.
        close: share of the cost.
    """
    rows, jacobian = residuals(x)
    cost, count, growth = float(rows @ rows), 1, 2.0
    while count < evaluations and damping < _MOST:
        step, promised = _step(rows, jacobian, damping)
        if promised <= close * cost:
            return Minimum(x + step, 0.5 * (cost - promised), count)
        tried = residuals(x + step)
        gain, count = (cost - float(tried[0] @ tried[0])) / promised, count + 1
        if gain > 0:
            x, (rows, jacobian) = x + step, tried
            cost, growth = float(rows @ rows), 2.0
            damping *= max(_LEAST_SHARE, 1 - (2 * gain - 1) ** 3)
        else:
            damping, growth = damping * growth, 2 * growth
    return Minimum(x, 0.5 * cost, count)


def _step(rows: Rows, jacobian: Rows, damping: float) -> tuple[Rows, float]:
    """The damped Gauss-Newton step, and by how much the linear model says that the sum of squares falls."""
    squares, slope = jacobian.T @ jacobian, jacobian.T @ rows
    step = np.asarray(-np.linalg.solve(squares + damping * np.eye(len(slope)), slope), np.float64)
    return step, float(-2 * (slope @ step) - step @ squares @ step)
