"""Who walks: the sizes that decide what is walkable."""

from __future__ import annotations

import math
from dataclasses import dataclass

from motionrt.errors import InvalidInputError
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown


@dataclass(frozen=True)
class Agent:
    """A walker; the defaults are a grown-up human.

    Attributes:
        radius: metres of free ground wanted around the centre of the body.
        step_height: metres that a foot steps up or down at once (meshes only).
        max_slope: steepest ground in degrees (meshes only).
        head_room: metres that must be free above the ground (meshes only).
        comfort: metres of clearance beyond which more is no better; where there is room, paths keep it.

    Raises:
        InvalidInputError: a length below zero, a slope outside [0, 90), or a step as high as the head room.
    """

    radius: float = 0.25
    step_height: float = 0.3
    max_slope: float = 40.0
    head_room: float = 1.8
    comfort: float = 0.7

    def __post_init__(self) -> None:
        for name in ("radius", "step_height", "head_room", "comfort"):
            value = getattr(self, name)
            if not 0 <= real(value) < math.inf:
                raise InvalidInputError(f"the agent's {name} must be a number of metres >= 0, not {shown(value)}")
        if not 0 <= real(self.max_slope) < 90:
            raise InvalidInputError(f"the agent's max_slope must lie in [0, 90) degrees, not {shown(self.max_slope)}")
        if self.head_room <= self.step_height:
            raise InvalidInputError("the agent's head_room must be larger than its step_height")
