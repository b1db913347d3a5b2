"""Long motions in batches of frames: little memory beside the result, and Ctrl-C is heard between two of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[Any]

BATCH = 4096
"""Frames of a batch: a hundredth of a second for 24 joints."""


def fill(out: Values, values: npt.ArrayLike) -> None:
    """``out[:] = values`` of ``(F, ...)``, some thousand frames at a time; what has no frames is the same in all."""
    spread = np.broadcast_to(np.asarray(values), out.shape)
    for start in range(0, len(out), BATCH):
        out[start : start + BATCH] = spread[start : start + BATCH]


def by_batches(function: Callable[..., Values], *arrays: Values) -> Values:
    """``function(*arrays)`` of arrays ``(F, ...)``, where every frame of the result depends on that frame alone."""
    frames = len(arrays[0])
    if frames <= BATCH:
        return function(*arrays)
    first = function(*(array[:BATCH] for array in arrays))
    out = np.empty((frames, *first.shape[1:]), first.dtype)
    out[:BATCH] = first
    for start in range(BATCH, frames, BATCH):
        out[start : start + BATCH] = function(*(array[start : start + BATCH] for array in arrays))
    return out
