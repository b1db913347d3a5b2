"""What a walker may be asked for beside a goal: a velocity, as of a stick, a facing, a speed to arrive with."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import FloatArray

COLUMNS = 8
"""Of a row: 1 and a velocity (x, z) m/s, 1 and a facing (x, z) of length 1, 1 and a speed m/s to arrive with; zeros
where nothing of the kind is wished."""
FASTEST = 6.0  # m/s that may be wished


@dataclass(frozen=True)
class Wish:
    """What a walker is asked for; ``None`` leaves it to the walker.

    Attributes:
        velocity: (x, z) m/s over the ground, in the world, over the next half second; it takes the place of a goal.
        facing: where the body looks in half a second, radians from +Z towards +X, whichever way it goes.
        arrival: m/s at the goal; 0 stands still there.

    Raises:
        InvalidInputError: numbers that are not finite, or more than 6 m/s.
    """

    velocity: tuple[float, float] | None = None
    facing: float | None = None
    arrival: float | None = None

    def __post_init__(self) -> None:
        numbers = [*(self.velocity or ()), *(x for x in (self.facing, self.arrival) if x is not None)]
        if not np.isfinite(numbers).all() or (self.velocity is not None and len(self.velocity) != 2):
            raise InvalidInputError("a wish needs finite numbers: velocity (x, z) m/s, facing radians, arrival m/s")
        fastest = max(np.hypot(*(self.velocity or (0.0, 0.0))), abs(self.arrival or 0.0))
        if fastest > FASTEST:
            raise InvalidInputError(f"nobody walks at {fastest:.1f} m/s; wish for at most {FASTEST:g}")

    def row(self) -> tuple[float, ...]:
        """The eight columns, in the world."""
        way = (1.0, *self.velocity) if self.velocity is not None else (0.0, 0.0, 0.0)
        look = (1.0, sin(self.facing), cos(self.facing)) if self.facing is not None else (0.0, 0.0, 0.0)
        return (*way, *look, *((1.0, self.arrival) if self.arrival is not None else (0.0, 0.0)))


def wishes_to_goal(wishes: Array, goals: Array) -> FloatArray:
    """Rows ``(B, 8)`` in the world -> as goals ``(B, 3)`` (x, z, heading) see them."""
    c, s = np.cos(goals[:, 2]), np.sin(goals[:, 2])
    out = np.array(wishes, dtype=np.float32)
    for first in (1, 4):
        x, z = wishes[:, first], wishes[:, first + 1]
        out[:, first], out[:, first + 1] = c * x - s * z, s * x + c * z
    return out
