"""Where to stand in front of a thing: at its open side, with nothing in the way, near to where one comes from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from motionrt.locomotion.words.footprint import Plan, Side, plan
from motionrt.motion.skeleton import FloatArray

BODY = 0.20  # metres of free ground around somebody who stands
TOES = 0.10  # metres that the balls of the feet are in front of the body's middle
LOW, HIGH = 0.10, 1.80  # metres above the ground between which things are in the way
_CHEST = 0.90  # metres above the ground; an arm reaches over what is lower
_FURTHEST = 0.60  # metres that one steps back from a blocked spot


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What is around a thing.

    Attributes:
        floor: height of the ground.
        obstacles: ``(N, 2)`` ground plan of what is in the way.
        screens: ``(N, 2)`` of it, what no arm reaches over.
        ground: ``(N, 2)`` ground plan of the ground, or None where nothing is labelled so.
        near: ``(2,)`` where one comes from, else the middle of the scene.
        weight: how much a metre from ``near`` counts.
    """

    floor: float
    obstacles: Plan
    screens: Plan
    ground: Plan | None
    near: Plan
    weight: float

    def blocked(self, spot: Plan) -> int:
        """How many points are in the way of somebody at ``spot`` ``(2,)``."""
        return int((np.linalg.norm(self.obstacles - spot, axis=1) < BODY).sum())

    def screened(self, spot: Plan, target: Plan) -> bool:
        """Whether something stands between ``spot`` and ``target`` ``(2,)``, more than a hand's width before it."""
        reach = max(float(np.linalg.norm(spot - target)), 1e-6)
        ahead = (spot - target) / reach
        along, beside = (self.screens - target) @ ahead, (self.screens - target) @ np.array([-ahead[1], ahead[0]])
        return bool(((along > 0.1) & (along < reach) & (np.abs(beside) < 0.1)).any())

    def grounded(self, spot: Plan) -> bool:
        """Whether there is ground under ``spot``, as far as is known."""
        return self.ground is None or bool((np.linalg.norm(self.ground - spot, axis=1) < 0.3).any())


@dataclass(frozen=True, eq=False)
class Spot:
    """A place to stand at: a side of the thing, metres along it and in front of it (of the body's middle)."""

    side: Side
    across: float
    outside: float
    cost: float

    @property
    def place(self) -> Plan:
        """``(2,)`` the body's middle."""
        return self.side.at(self.across, self.outside)


def surroundings(points: FloatArray, floor: float, ground: Plan | None, near: Plan, weight: float) -> Surroundings:
    """Of obstacles' points ``(N, 3)``, what a body could bump into and what its arms could not reach over."""
    heights = points[:, 1] - floor
    low, high = plan(points[(heights > LOW) & (heights < HIGH)]), plan(points[(heights > _CHEST) & (heights < HIGH)])
    return Surroundings(floor, low, high, ground, near, weight)


def spot_at(side: Side, across: float, outside: float, around: Surroundings) -> Spot:
    """The first free spot in front of a side, from ``outside`` metres on; the first one if none is free."""
    for step in np.arange(0.0, _FURTHEST + 1e-6, 0.05):
        if not around.blocked(side.at(across, outside + step)):
            return Spot(side, across, outside + float(step), _cost(side, across, outside + float(step), around))
    return Spot(side, across, outside, 5.0 + _cost(side, across, outside, around))


def best(spots: Sequence[Spot]) -> Spot:
    """The spot of lowest cost; the first of equals."""
    return min(spots, key=lambda spot: spot.cost)


def _cost(side: Side, across: float, outside: float, around: Surroundings) -> float:
    spot = side.at(across, outside)
    narrow = side.width < 0.5 and side.width < 0.6 * side.depth  # the end of a shelf or a wall
    far = around.weight * float(np.linalg.norm(spot - around.near))
    barred = not around.grounded(spot) or around.screened(spot, side.at(across, 0.0))
    return far + 1.0 * narrow + 5.0 * barred + outside
