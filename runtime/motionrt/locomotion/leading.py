"""Where a walker is led in the next half second, so that it can follow: to a goal that may be anywhere, or by a stick.

A network that is asked to be behind itself at once orbits, or leaps. Here the way wanted turns by no more than somebody
who walks can turn, the speed rises and falls as people's does, and who has to go back stops first.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, hypot, sin, sqrt

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.bearings import Place
from motionrt.locomotion.goal_frame import Goal, frames_from_goal, frames_to_goal
from motionrt.locomotion.wishes import Wish
from motionrt.motion.rotations import Array, wrapped

SHARPEST = 0.7  # radians between where somebody looks and where the way wanted may lead
BEHIND = 1.3  # radians: a near goal further aside is stopped for
NEAR_BEHIND = 2.0  # metres that are near for that
BRAKES = 1.3  # m/s lost per second
THERE = 0.75  # metres from a goal at which the walk ends; steps do the rest
STEPS_FROM = 1.9  # m/s: who is faster slows down before a walk ends in steps ...
SLOW = 1.1  # ... to this
ASIDE = 0.7  # radians between way and facing: more is stepped, or strafed by a network that knows wishes ...
STRAFES_TO = 1.5  # ... at most so fast, m/s
AHEAD = 1.0  # metres from a walker to the place that it is led to
FREE, HELP, MOST = 0.25, 0.05, 0.03  # radians aside that need no help; radians a frame for each beyond, and the most
SLOWEST = 0.6  # of the speed, in the sharpest turns
HURRIES, MOST_HURRIED = 1.0, 1.15  # m/s more that are asked for each that is missing, and the most, as a factor
STANDS = 0.05  # m/s: less is standing
WALKS_FROM = 0.6  # m/s: what is slower is stepped


@dataclass
class Lead:
    """What is wanted of a walker now: ``speed`` m/s along ``way`` radians, looking at ``facing``.

    ``way`` is kept within what can be followed; ``bends`` is how much farther the arc turns that leads there, radians.
    """

    speed: float
    way: float
    facing: float
    bends: float = 0.0

    @property
    def faces_aside(self) -> bool:
        """Whether somebody shall look elsewhere than it goes."""
        return abs(float(wrapped(self.facing - self.way))) > 1e-6

    def wish(self) -> Wish:
        """As a wish."""
        return Wish((self.speed * sin(self.way), self.speed * cos(self.way)), self.facing)

    def goal(self, place: Place) -> Goal:
        """As a goal, which every network knows."""
        x, z = place[0] + AHEAD * sin(self.way), place[1] + AHEAD * cos(self.way)
        return Goal(x, z, self.way + self.bends)  # on an arc, whose chord leads there


def led(goals: Array, frames: Array) -> npt.NDArray[np.float64]:
    """Goals ``(B, 3)``, those that lie far aside of where a walker looks replaced by a place that it can turn to.

    Args:
        goals: x, z and heading of each.
        frames: ``(B, 219)`` the last frame of each walker.
    """
    place, facing, off = frames[:, [216, 218]], np.arctan2(frames[:, 2], frames[:, 8]), _aside(goals, frames)
    turned = facing + np.clip(off, -SHARPEST, SHARPEST)
    near = place + AHEAD * np.stack([np.sin(turned), np.cos(turned)], axis=1)
    return np.where(np.abs(off)[:, None] > SHARPEST, np.column_stack([near, 2 * turned - facing]), goals)


def helped(goals: Array, history: Array, most: float | Array = MOST) -> npt.NDArray[np.float64]:
    """Histories ``(B, 30, 219)`` turned a little about where each walker is, towards a goal that lies aside.

    A walk that is bent so stays a walk; what its standing feet turn is for the foot lock, as in the bent walks of the
    training data. Some gaits turn slowly by themselves.

    Args:
        goals: ``(B, 3)`` x, z and heading of each.
        history: the last second of each.
        most: radians a frame, one for all or ``(B,)``.
    """
    place, off = history[:, -1, [216, 218]], _aside(goals, history[:, -1])
    turn = np.sign(off) * np.minimum(np.maximum(np.abs(off) - FREE, 0.0) * HELP * np.asarray(most) / MOST, most)
    about = np.column_stack([place, np.zeros(len(place))])
    turned = frames_from_goal(frames_to_goal(history, about), np.column_stack([place, turn]))
    return np.where((turn != 0.0)[:, None, None], turned, history)


def slowed(goals: Array, frames: Array, speed: float) -> npt.NDArray[np.float64]:
    """``(B,)`` m/s: who has to turn much goes slower."""
    return np.asarray(speed * np.clip(1.25 - 0.6 * np.abs(_aside(goals, frames)), SLOWEST, 1.0))


def _aside(goals: Array, frames: Array) -> npt.NDArray[np.float64]:
    """``(B,)`` radians between where walkers look and where their goals are."""
    way = goals[:, :2] - frames[:, [216, 218]]
    return np.asarray(wrapped(np.arctan2(way[:, 0], way[:, 1]) - np.arctan2(frames[:, 2], frames[:, 8])))


def asked_for(wanted: float, now: float) -> float:
    """The speed to ask a walker for who goes ``now`` and shall go ``wanted``, m/s: who is slow is asked for more."""
    return min(MOST_HURRIED * wanted, wanted + HURRIES * max(0.0, wanted - now))


def towards(goal: Goal, place: Place, facing: float, now: float, pace: float) -> Lead | None:
    """The way to a goal for who is at ``place``, looks at ``facing`` and goes ``now`` m/s; ``pace`` is the most.

    None where the walk has to end first: the goal is near, or near and behind.
    """
    dx, dz = goal.x - place[0], goal.z - place[1]
    away = hypot(dx, dz)
    off = float(wrapped(float(np.arctan2(dx, dz)) - facing))
    near = away < THERE or (away < NEAR_BEHIND and abs(off) > BEHIND)
    if near and now < STEPS_FROM:
        return None
    way = facing + float(np.clip(off, -SHARPEST, SHARPEST))
    most = SLOW if near else min(pace, max(SLOW, sqrt(2 * BRAKES * max(away - THERE, 0.0))))
    return Lead(most, way, way, way - facing)


def by_stick(
    velocity: tuple[float, float], facing: float | None, looks: float, now: float, *, strafes: bool = False
) -> Lead | None:
    """The way that a stick wants, for who looks at ``looks`` and goes ``now`` m/s.

    None where nothing is wanted, or what is stepped and not walked: very slowly, and sideways or backwards unless the
    network ``strafes``.
    """
    wanted = hypot(*velocity)
    way = float(np.arctan2(velocity[0], velocity[1])) if wanted > STANDS else looks
    aside = facing is not None and abs(wrapped(way - facing)) > ASIDE
    if aside and strafes and wanted >= WALKS_FROM:
        turn = float(np.clip(wrapped((looks if facing is None else facing) - looks), -SHARPEST, SHARPEST))
        return Lead(min(wanted, STRAFES_TO), way, looks + turn)
    if wanted < WALKS_FROM or aside:
        return None if now < STEPS_FROM else Lead(SLOW, looks, looks)
    way = looks + float(np.clip(wrapped(way - looks), -SHARPEST, SHARPEST))
    return Lead(wanted, way, way if facing is None else facing, way - looks)
