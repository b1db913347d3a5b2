"""What is held of a view in training, so that the denoiser learns to keep it: starts, poses, paths, body parts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from motionrt.motion.body_parts import PARTS

ROOT = PARTS.index("global")
KINDS = (0.34, 0.12, 0.18, 0.18, 0.18)  # start, start and end, poses, path, parts


def draw_holding(frames: int, rng: np.random.Generator) -> NDArray[np.bool_]:
    """(F, 6) which parts of which frames are held, drawn anew."""
    held = np.zeros((frames, len(PARTS)), bool)
    kind = int(rng.choice(len(KINDS), p=KINDS))
    if kind in (0, 1):
        held[: int(rng.integers(1, max(2, min(20, frames // 2))))] = True
    if kind == 1:
        held[-int(rng.integers(1, 4)) :] = True
    if kind == 2:
        places = rng.choice(frames, size=min(frames, int(rng.integers(1, 7))), replace=False)
        held[places] = True if rng.random() < 0.6 else rng.random(len(PARTS)) < 0.5
    if kind == 3:
        first, last = sorted(rng.integers(0, frames + 1, size=2).tolist()) if rng.random() < 0.3 else (0, frames)
        held[first:last, ROOT] = True
    if kind == 4:
        first, last = sorted(rng.integers(0, frames + 1, size=2).tolist()) if rng.random() < 0.5 else (0, frames)
        held[first:last] = rng.random(len(PARTS)) < 0.5
    return held
