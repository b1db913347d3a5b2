"""Steps in a transition: feet that have to go elsewhere are lifted there one after the other, all others stay.

TransNet knows well where a body goes in two seconds, and lets its feet glide there. Here the body keeps its way, and
its legs reach for feet that stand where they stood, swing once, when the network moved them most, and stand where the
pose that follows has them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.footfalls import LEAD, PAUSE, SWING, Footfall
from motionrt.locomotion.stepping import (
    IN_THE_AIR,
    Stand,
    displaced,
    feet_over,
    foot_behind,
    last_speed,
    longer_for,
    with_legs,
)
from motionrt.motion import Motion
from motionrt.motion.feet.two_bone import LEG_JOINTS

LEFT = 5  # frames at the end in which both feet stand
LOWERS, STILL_UP = 0.15, 0.45  # metres that who sits down or rises goes down or up; share of that done while feet step
FARTHEST = 1.2  # metres of a step: a foot that goes farther takes two; one that needs more goes as the network says

_ANKLES = [leg[2] for leg in LEG_JOINTS]

Values = npt.NDArray[np.float64]


def with_steps(seed: Motion, made: Motion) -> Motion:
    """A transition whose feet step.

    Args:
        seed: what came before, 30 fps, on ``smpl24``.
        made: the frames behind it; the last one is the pose that is aimed at, and stays as it is.
    """
    start, end = Stand.of(seed[-1:]), Stand.of(made[-1:])
    steps = _planned(start, end, made, foot_behind(start, last_speed(seed)))
    if steps is None:
        return made
    feet, turns = feet_over(start, end, steps, made.frames)
    rotations, root = made.rotations.astype(np.float64), made.root.astype(np.float64)
    rotations, root = with_legs(rotations, root, feet, turns, np.zeros(made.frames))
    rotations[-1], root[-1] = made.rotations[-1], made.root[-1]
    return replace(made, rotations=rotations.astype(np.float32), root=root.astype(np.float32))


def _planned(start: Stand, end: Stand, made: Motion, behind: int | None) -> list[Footfall] | None:
    """Steps for each foot that is displaced, in the order in which the network moves them; None if one is too far."""
    off = np.hypot(*(end.ankles - start.ankles)[:, [0, 2]].T)
    far = off > FARTHEST
    if (off > 2 * FARTHEST).any():
        return None
    when = _when(start, end, made, behind)
    feet = [int(foot) for foot in np.argsort(when) if displaced(start, end)[foot]]
    falls = [*((foot, 0.5) for foot in feet if far[foot]), *((foot, 1.0) for foot in feet)]
    lengths = [SWING + longer_for(float(off[foot]) / (2 if far[foot] else 1)) for foot, _ in falls]
    begin, finish = (1, made.frames - LEFT) if far.any() else _upright(start, end, made)
    latest = finish - sum(lengths) - PAUSE * max(0, len(falls) - 1)
    steps: list[Footfall] = []
    for (foot, share), length in zip(falls, lengths, strict=True):
        earliest = steps[-1].end + PAUSE if steps else 1 if when[foot] <= 0.0 else begin
        wanted = earliest if far.any() else round(when[foot] - length / 2)
        first = int(np.clip(wanted, earliest, max(earliest, latest)))
        steps.append(Footfall(foot, first, first + length, share))
        latest += length + PAUSE
    return steps if not steps or steps[-1].end < made.frames else None


def _when(start: Stand, end: Stand, made: Motion, behind: int | None) -> Values:
    """``(2,)`` in the middle of which frames the network moves each foot; 0 or less for one that has to go at once."""
    ankles = made.positions()[:, _ANKLES].astype(np.float64)
    moved = np.linalg.norm(np.diff(np.concatenate([start.ankles[None], ankles]), axis=0), axis=2)
    middles = np.arange(1, made.frames + 1) @ moved / np.maximum(moved.sum(axis=0), 1e-9)
    if behind is not None:
        middles[behind] = 0.0  # a walk goes on with the foot that is behind ...
    high = start.ankles[:, 1] - end.ankles[:, 1]
    return np.where(high > IN_THE_AIR, -high, middles)  # ... or in the air


def _upright(start: Stand, end: Stand, made: Motion) -> tuple[int, int]:
    """The first and the last frame for steps: who sits down steps before, who rises steps afterwards."""
    begin, finish, lower = LEAD, made.frames - LEFT, float(start.root[1] - end.root[1])
    if abs(lower) < LOWERS:
        return begin, finish
    done = (start.root[1] - made.root[:, 1]) / lower
    if lower > 0:
        return begin, int((done > STILL_UP).argmax())
    return min(int((done > 1.0 - STILL_UP).argmax()), finish - 2 * SWING), finish
