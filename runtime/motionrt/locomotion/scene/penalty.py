"""What it costs to walk close to obstacles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.scene.grid import Grid, Points
from motionrt.locomotion.scene.tracing import clearance_along


@dataclass(frozen=True)
class Penalty:
    """A metre with clearance ``c`` costs ``1 + weight * ((comfort - c) / comfort)^2``, and 1 from ``comfort`` on.

    Attributes:
        comfort: metres.
        weight: how dear closeness is; 0 gives the shortest paths.
    """

    comfort: float
    weight: float = 4.0

    def factor(self, clearance: npt.ArrayLike) -> Points:
        """Cost of a metre ``[...]`` for clearances ``[...]``."""
        if self.comfort <= 0 or self.weight <= 0:
            return np.ones(np.shape(clearance))
        lack = np.maximum(1 - np.asarray(clearance, dtype=np.float64) / self.comfort, 0)
        return np.asarray(1 + self.weight * lack**2)

    def costs(self, grid: Grid, start: Points, end: Points) -> Points:
        """Cost ``(E,)`` of straight ways from ``(E, 2)`` to ``(E, 2)``; infinite where a way is not free."""
        clearance, metres = clearance_along(grid, start, end)
        free = (clearance >= grid.least_clearance).all(axis=1)
        return np.where(free, (self.factor(clearance) * metres).sum(axis=1), np.inf)
