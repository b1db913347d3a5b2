"""Which of several samples does best what the text says: by what is measured, and by a retrieval model."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.motion.attributes.body import SIDES
from motionrt.synthesis.timeline import Line
from motionrt.text import agreement, parse_query

Likeness = Callable[[str, Motion], float]
"""A text and a motion -> cosine of their embeddings."""

BROKEN_OFF = 0.5  # what an end in the middle of a kick or a jump counts against it
_END_S, _MOVING = 0.1, 0.4  # seconds that are looked at; m/s
_HIGH, _JUMPING = 0.35, 0.12  # metres of one ankle, and of both, above where they stand
LIKE = 0.5  # what a cosine counts beside an agreement of 0 to 1


def best(motions: Sequence[Motion], lines: Sequence[Line], likeness: Likeness) -> int:
    """Number of the motion that agrees best with its texts, each over its own time, and does not break off."""
    rates = [float(np.mean([rated(motion, line, likeness) for line in lines])) for motion in motions]
    return int(np.argmax(np.array(rates) - BROKEN_OFF * np.array([breaks_off(motion) for motion in motions])))


def breaks_off(motion: Motion) -> bool:
    """Whether a motion ends in the middle of a kick or a jump.

    That is: a foot is higher than any step lifts it, or both are in the air, and moves still.
    """
    last = motion[-min(motion.frames, max(2, round(_END_S * motion.fps))) :].positions()
    ankles = [motion.skeleton.index(f"{side}_ankle") for side in SIDES]
    floor = motion.positions()[:, ankles, 1].min()
    lifts = last[-1, ankles, 1] - floor
    moved = np.linalg.norm(last[-1, ankles] - last[0, ankles], axis=-1) * motion.fps / (len(last) - 1 or 1)
    kicking = (lifts > _HIGH) & (moved > _MOVING)
    return bool(kicking.any() or (lifts.min() > _JUMPING and moved.max() > _MOVING))


def rated(motion: Motion, line: Line, likeness: Likeness) -> float:
    """How well a motion does during a line what it says."""
    part = motion.between(line.start, min(line.end, motion.duration))
    return float(agreement(parse_query(line.text), measure(part))) + LIKE * likeness(line.text, part)
