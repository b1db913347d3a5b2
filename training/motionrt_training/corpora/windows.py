"""The stretches of a clip that training looks at: what is measured there, and what may be said of short ones."""

from __future__ import annotations

import numpy as np

from motionrt.motion.attributes import Attributes, measure
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import FloatArray
from motionrt.text.slots import mirror_slots, slots_of_motion
from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.wording.measured import say_measured

CROPS, LEAST = 4, 0.6  # crops that the clip's captions still describe, and how much of it they keep at least
MOMENTS, SHORT, LONG = 4, 10, 100  # short stretches with sentences of their own, frames at 20 fps
SPOKEN = 2
LONGEST, FPS = 200, guo263.FPS

Row = list[object]


def windows_of(positions: FloatArray, rng: np.random.Generator) -> list[Row]:
    """Rows of `motionrt_training.packed.Window` for joints (F, 24, 3) at 20 fps: all, crops, moments with own texts."""
    frames = len(positions)
    spans = [(0, min(frames, LONGEST))]
    if frames > 20:
        spans += [_span(frames, int(rng.integers(int(LEAST * frames), frames + 1)), rng) for _ in range(CROPS)]
    rows = [
        _row(measure(positions[first : first + count], FPS), first, min(count, LONGEST), []) for first, count in spans
    ]
    for _ in range(MOMENTS if frames > SHORT else 0):
        first, count = _span(frames, int(rng.integers(SHORT, min(LONG, frames) + 1)), rng)
        found = measure(positions[first : first + count], FPS)
        said = say_measured(found, rng, SPOKEN)
        rows += [_row(found, first, count, said)] if said else []
    return rows


def _span(frames: int, count: int, rng: np.random.Generator) -> tuple[int, int]:
    return int(rng.integers(0, frames - count + 1)), count


def _row(found: Attributes, first: int, count: int, said: list[str]) -> Row:
    own = slots_of_motion(found)
    slots = [own.tolist(), mirror_slots(own).tolist()]
    return [first, count, *slots, said, [mirror_text(text) for text in said]]
