"""Many characters on several cores: the batch in pieces, each piece on one thread."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from motionrt.locomotion.walking import NextFrame
from motionrt.models.threads import thread_count
from motionrt.motion.skeleton import FloatArray

PIECE = 8  # characters in one call of the model; more in one call are no cheaper


class Spread:
    """A model of next frames that shares its batches out among threads.

    Args:
        model: predicts next frames, and may be called by several threads at once, as an onnxruntime session may. Open
            its session with one thread: ``Sessions(threads=1)``.
        threads: threads that call it, by default at most 2 of those that the process may use.

    Raises:
        InvalidInputError: ``threads`` is not a whole number above 0.
    """

    def __init__(self, model: NextFrame, threads: int | None = None) -> None:
        self.model, self.threads = model, thread_count(threads)
        self._pool = ThreadPoolExecutor(self.threads, thread_name_prefix="motionrt-walk")

    def __call__(self, frames: FloatArray, speed: FloatArray) -> FloatArray:
        """Next frames ``(B, 219)``, as the model gives them; see :data:`motionrt.locomotion.walking.NextFrame`."""
        count = min(len(frames), pieces(len(frames), self.threads))
        if count <= 1:
            return self.model(frames, speed)
        parts = zip(np.array_split(frames, count), np.array_split(speed, count), strict=True)
        return np.concatenate(list(self._pool.map(lambda part: self.model(*part), parts)))


def pieces(characters: int, threads: int) -> int:
    """In how many pieces of at most 8 a batch is cut so that every thread has as many."""
    return -(-characters // (PIECE * threads)) * threads
