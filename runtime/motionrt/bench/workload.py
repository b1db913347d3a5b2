"""What is measured: the same inputs for motionrt and for whatever it is compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from motionrt.bench.locomotion import Moves
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Clip, Gallery
from motionrt.retrieval.records import ModelStamp, window_table
from motionrt.retrieval.windows import WINDOW_FRAMES

SIZES = (1_000, 10_000, 100_000)  # of galleries; any others on request
TOP = 10
TEXTS = (
    "a person walks forward slowly and then turns around to the left",
    "someone jumps up and down twice with both arms raised above the head",
    "a man sits down on a chair, waits a moment and stands up again",
    "the person kicks with the right leg and steps back into a guard",
)


@dataclass(frozen=True)
class Workload:
    """Inputs, made from a fixed seed when they are first asked for.

    Attributes:
        sizes: how many vectors are searched, smallest first.
        texts: sentences of 12 to 16 tokens.
    """

    sizes: tuple[int, ...] = SIZES
    texts: tuple[str, ...] = TEXTS

    @classmethod
    def standard(cls, sizes: Sequence[int] = SIZES) -> Workload:
        """The inputs of ``motionrt bench``."""
        return cls(tuple(sorted(sizes)))

    @cached_property
    def features(self) -> FloatArray:
        """``(200, 263)`` feature window."""
        return np.random.default_rng(0).normal(size=(WINDOW_FRAMES, guo263.WIDTH)).astype(np.float32)

    @cached_property
    def vectors(self) -> FloatArray:
        """``(largest size, 256)`` random unit vectors; a smaller search takes the first of them."""
        vectors = np.random.default_rng(1).standard_normal((max(self.sizes), 256), np.float32)
        vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
        return vectors

    @cached_property
    def moves(self) -> Moves:
        """What is walked, changed into and posed."""
        return Moves.standard()

    def gallery(self, size: int, model: str, fingerprint: str) -> Gallery:
        """So many clips with the first of the vectors, as if that model had made them."""
        clips = tuple(Clip(f"{number:07d}", 10.0) for number in range(size))
        windows = window_table([[(0.0, 10.0)]] * size)
        return Gallery(clips, self.vectors[:size], windows, ModelStamp(model, fingerprint))
