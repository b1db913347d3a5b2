"""Which of several samples does best what the text says: by what is measured, and by a retrieval model."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.synthesis.timeline import Line
from motionrt.text import agreement, parse_query

Likeness = Callable[[str, Motion], float]
"""A text and a motion -> cosine of their embeddings."""

LIKE = 0.5  # what a cosine counts beside an agreement of 0 to 1


def best(motions: Sequence[Motion], lines: Sequence[Line], likeness: Likeness) -> int:
    """Number of the motion that agrees best with its texts, each over its own time."""
    return int(np.argmax([float(np.mean([rated(motion, line, likeness) for line in lines])) for motion in motions]))


def rated(motion: Motion, line: Line, likeness: Likeness) -> float:
    """How well a motion does during a line what it says."""
    part = motion.between(line.start, min(line.end, motion.duration))
    return float(agreement(parse_query(line.text), measure(part))) + LIKE * likeness(line.text, part)
