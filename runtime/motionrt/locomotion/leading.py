"""Where a walker is led in the next half second, so that it can follow: to a goal that may be anywhere, or by a stick.

A network that is asked to be behind itself at once orbits, or leaps. Here the way wanted turns by no more than somebody
who walks can turn, the speed rises and falls as people's does, and who has to go back stops first.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

import numpy as np

from motionrt.locomotion.bearings import Place
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.wishes import Wish
from motionrt.motion.rotations import wrapped

SHARPEST = 0.9  # radians between where somebody looks and where the way wanted may lead
BEHIND = 1.3  # radians: a near goal further aside is stopped for
NEAR_BEHIND = 2.0  # metres that are near for that
BRAKES, RISES = 1.3, 2.2  # m/s lost and won per second
THERE = 0.35  # metres from a goal at which the walk ends; steps do the rest
AHEAD = 1.5  # metres from a walker to the place that it is led to
RUNS_AT = 0.05  # m/s: less is standing


@dataclass
class Lead:
    """What is wanted of a walker now: ``speed`` m/s along ``way`` radians, looking at ``facing``.

    ``facing`` may be any; the others are kept within what can be followed.
    """

    speed: float
    way: float
    facing: float

    def wish(self) -> Wish:
        """As a wish."""
        return Wish((self.speed * sin(self.way), self.speed * cos(self.way)), self.facing)

    def goal(self, place: Place) -> Goal:
        """As a goal, for a network that knows nothing else."""
        return Goal(place[0] + AHEAD * sin(self.way), place[1] + AHEAD * cos(self.way), self.way)


def towards(goal: Goal, place: Place, facing: float, now: float, pace: float, fps: float) -> Lead:
    """The way to a goal for who is at ``place``, looks at ``facing`` and goes ``now`` m/s; ``pace`` is the most."""
    dx, dz = goal.x - place[0], goal.z - place[1]
    away = hypot(dx, dz)
    bearing = float(np.arctan2(dx, dz))
    off = float(wrapped(bearing - facing))
    if away < THERE or (away < NEAR_BEHIND and abs(off) > BEHIND):
        return Lead(0.0, facing, facing if away > THERE else _between(facing, goal.heading))
    most = min(pace, sqrt(2 * BRAKES * max(away - THERE / 2, 0.0)))
    way = facing + float(np.clip(off, -SHARPEST, SHARPEST))
    most *= max(0.5, cos(min(abs(off), SHARPEST) * 0.9))
    return Lead(_followed(now, most, fps), way, way)


def by_stick(velocity: tuple[float, float], facing: float | None, looks: float, now: float, fps: float) -> Lead:
    """The way that a stick wants, for somebody who looks at ``looks`` and goes ``now`` m/s."""
    wanted = hypot(*velocity)
    way = float(np.arctan2(velocity[0], velocity[1])) if wanted > RUNS_AT else looks
    if facing is None:  # looks where it goes, and turns there no faster than it can
        way = looks + float(np.clip(wrapped(way - looks), -SHARPEST, SHARPEST))
        return Lead(_followed(now, wanted, fps), way, way)
    return Lead(_followed(now, wanted, fps), way, _between(looks, facing))


def _between(facing: float, wanted: float) -> float:
    """As far towards a heading as somebody turns in half a second."""
    return facing + float(np.clip(wrapped(wanted - facing), -SHARPEST, SHARPEST))


def _followed(now: float, wanted: float, fps: float) -> float:
    """The speed half a second on: from the present one, no faster than people gain and lose it."""
    half = 0.5
    return float(np.clip(wanted, now - BRAKES * half, now + RISES * half)) if fps > 0 else wanted
