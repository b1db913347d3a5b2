"""Which foot is set where and when, so that somebody who stands comes to stand elsewhere by steps.

Short ways are walked foot past foot; sideways, and where the body turns much, one foot opens and the other closes.
Everything is told by the body's share of the way: a foot that lands at share u lands where it would stand if the body
stood at u.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
import numpy.typing as npt

STRIDE, CLOSING = 0.45, 0.42  # metres of a step past the other foot, and of a pair of steps that open and close
SHORTEST = 0.12  # metres of a step, however slow the pace
TURN, PAST_TURN = 1.58, 0.35  # radians that a pair turns, and a step past the other foot
FPS = 30.0
SWING, QUICK = 11, 10  # frames that a foot is in the air, and in steps that open and close
PAUSE = 1  # frames between steps with both feet down
LEAD, SETTLE = 4, 7  # frames before the first step and behind the last
EVEN = 1e-3  # metres to a side that are none
NARROW = 0.5  # metres sideways per metre ahead: more is a side step

Shares = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Footfall:
    """One step.

    Attributes:
        foot: 0 left, 1 right.
        start, end: frames; in the air from after ``start`` to before ``end``.
        share: of the body's way, where it lands.
    """

    foot: int
    start: int
    end: int
    share: float


def plan_steps(
    ahead: float,
    left: float,
    turn: float,
    displaced: tuple[bool, bool],
    first: int | None = None,
    longer: int = 0,
    pace: float = np.inf,
) -> list[Footfall]:
    """The steps that move a body by so much.

    Args:
        ahead: metres, seen from the way that the body faces half way.
        left: metres to the left of that.
        turn: radians to the left.
        displaced: whether the left and the right foot stand elsewhere than they shall stand at the end.
        first: a foot that has to go first, and at once, 0 left, 1 right: the one in the air, or behind in a walk.
        longer: frames that the first step takes longer than others.
        pace: m/s that steps shall not exceed; they get shorter.

    Returns:
        Steps in order of time; none where nothing is displaced. The motion lasts :func:`duration` frames.
    """
    far, step_s = float(np.hypot(ahead, left)), (SWING + PAUSE) / FPS
    stride, closing = (
        min(most, max(SHORTEST, pace * s)) for most, s in ((STRIDE, step_s), (CLOSING, 2 * (QUICK + PAUSE) / FPS))
    )
    past = abs(left) <= NARROW * abs(ahead) and abs(turn) <= PAST_TURN * max(1, ceil(far / stride))
    lead = LEAD if first is None else 1
    first = _first(left, turn, displaced) if first is None else first
    if past and far > stride / 4:
        count = ceil(far / stride)
        shares, swing = [min(1.0, (k + 1) / count) for k in range(count + 1)], SWING
    else:
        pairs = max(1, ceil(far / closing), ceil(abs(turn) / TURN))
        shares, swing = [(k // 2 + 1) / pairs for k in range(2 * pairs)], QUICK
    feet = [(first + k) % 2 for k in range(len(shares))]
    kept = [(foot, share) for foot, share in zip(feet, shares, strict=True) if displaced[foot] or far + abs(turn) > 0.1]
    out: list[Footfall] = []
    for foot, share in kept:
        start = out[-1].end + PAUSE if out else lead
        out.append(Footfall(foot, start, start + swing + (0 if out else longer), share))
    return out


def duration(steps: list[Footfall]) -> int:
    """Frames of the whole motion, until the body rests."""
    return (steps[-1].end if steps else 2 * LEAD) + SETTLE


def shares(steps: list[Footfall], frames: int) -> Shares:
    """``(F, 2)`` where each foot is on the body's way at each of the frames 1 to ``frames``."""
    now = np.arange(1, frames + 1)
    out = np.zeros((frames, 2))
    for step in steps:
        before = out[step.start - 1, step.foot]
        passed = eased((now - step.start) / (step.end - step.start))
        moving = now > step.start
        out[moving, step.foot] = (before + (step.share - before) * passed)[moving]
    return out


def swings(steps: list[Footfall], frames: int) -> Shares:
    """``(F, 2)`` how far each foot is through its step, 0 to 1; 0 where it stands."""
    now = np.arange(1, frames + 1)
    out = np.zeros((frames, 2))
    for step in steps:
        inside = (now > step.start) & (now < step.end)
        out[inside, step.foot] = ((now - step.start) / (step.end - step.start))[inside]
    return out


def eased(share: Shares) -> Shares:
    """0 to 1 with speed and acceleration zero at both ends."""
    s = np.clip(share, 0.0, 1.0)
    return s * s * s * (10 - 15 * s + 6 * s * s)


def _first(left: float, turn: float, displaced: tuple[bool, bool]) -> int:
    """The foot on the side that is gone to or turned to; else one that has to move."""
    if displaced[0] != displaced[1]:
        return 0 if displaced[0] else 1
    return 0 if left + 0.3 * turn >= -EVEN else 1
