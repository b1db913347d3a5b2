"""Following waypoints: which of them each character walks to now."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.rotations import Array

RADIUS = 0.4  # metres within which a waypoint counts as reached


class WaypointTargets:
    """The waypoints of ``B`` characters, and how far each has come.

    A waypoint is left behind when the character is within ``radius`` of it; one that was missed is walked back to. The
    last one stays the goal.

    Args:
        waypoints: for each character ``(N, 3)`` x, z, heading.
    """

    def __init__(self, waypoints: Sequence[Array], radius: float = RADIUS) -> None:
        if not waypoints or any(np.ndim(rows) != 2 or np.shape(rows)[1:] != (3,) for rows in waypoints):
            raise InvalidInputError("every route needs an array (N >= 1, 3) of x, z, heading")
        self.waypoints = [np.asarray(rows, dtype=np.float64) for rows in waypoints]
        self.radius = radius
        self.index = [0] * len(waypoints)

    def goals(self, positions: Array) -> npt.NDArray[np.float64]:
        """(B, 3): where each character, now at ``positions`` (B, 2), has to walk to."""
        return np.stack([self._goal(i, xz) for i, xz in enumerate(positions)])

    def ends(self) -> npt.NDArray[np.bool_]:
        """(B,) whether each is on its way to its last waypoint."""
        return np.array([i == len(rows) - 1 for i, rows in zip(self.index, self.waypoints, strict=True)])

    def _goal(self, character: int, xz: Array) -> npt.NDArray[np.float64]:
        rows = self.waypoints[character]
        while self.index[character] < len(rows) - 1 and self._reached(character, xz):
            self.index[character] += 1
        return np.asarray(rows[self.index[character]])

    def _reached(self, character: int, xz: Array) -> bool:
        off = xz - self.waypoints[character][self.index[character], :2]
        return bool(np.hypot(*off) < self.radius)
