"""Many characters on several cores: the batch in pieces, each piece on one thread."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from motionrt.locomotion.crowd import NextFrame, takes_wishes
from motionrt.models.threads import thread_count
from motionrt.motion.skeleton import FloatArray

FEWEST = 4  # characters that are worth a thread of their own


class Spread:
    """A model of next frames that shares its batches out among threads, one of which is the caller's.

    Args:
        model: predicts next frames, and may be called by several threads at once, as an onnxruntime session may. Open
            its session with one thread: ``Sessions(threads=1)``.
        threads: threads that call it, by default at most 2 of those that the process may use.

    Raises:
        InvalidInputError: ``threads`` is not a whole number above 0.
    """

    def __init__(self, model: NextFrame, threads: int | None = None) -> None:
        self.model, self.threads = model, thread_count(threads)
        self._pool = ThreadPoolExecutor(max(1, self.threads - 1), thread_name_prefix="motionrt-walk")

    @property
    def wishes(self) -> bool:
        """Whether the model knows wishes."""
        return takes_wishes(self.model)

    def __call__(self, frames: FloatArray, speed: FloatArray, *wishes: FloatArray) -> FloatArray:
        """Next frames ``(B, 219)``, as the model gives them; see :data:`motionrt.locomotion.crowd.NextFrame`."""
        count = pieces(len(frames), self.threads)
        if count <= 1:
            return self.model(frames, speed, *wishes)
        told = (frames, speed, *wishes)
        (first, *others) = zip(*(np.array_split(values, count) for values in told), strict=True)
        elsewhere = [self._pool.submit(self.model, *part) for part in others]
        return np.concatenate([self.model(*first), *(part.result() for part in elsewhere)])


def pieces(characters: int, threads: int) -> int:
    """In how many pieces a batch is cut: one for every thread, as long as each has 4 characters."""
    return max(1, min(threads, characters // FEWEST))
