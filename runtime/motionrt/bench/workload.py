"""What is measured: the same inputs for motionrt and for whatever it is compared with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from motionrt.bench.moves import Moves
from motionrt.bench.timing import Call
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Clip, ExactIndex, Gallery
from motionrt.retrieval.records import ModelStamp, window_table
from motionrt.retrieval.windows import WINDOW_FRAMES

TEXT, MOTION, ANSWER = "text encoding", "motion encoding, 200 frames", "text to top 10 of 10,000"
SEARCH_SIZES = (1_000, 10_000, 100_000)
TOP = 10
TEXTS = (
    "a person walks forward slowly and then turns around to the left",
    "someone jumps up and down twice with both arms raised above the head",
    "a man sits down on a chair, waits a moment and stands up again",
    "the person kicks with the right leg and steps back into a guard",
)


@dataclass(frozen=True, eq=False)
class Workload:
    """Inputs, made from a fixed seed.

    Attributes:
        texts: sentences of 12 to 16 tokens.
        features: ``(200, 263)`` feature window.
        vectors: ``(100000, 256)`` random unit vectors; a smaller search takes the first of them.
        moves: what is walked, changed into and posed.
    """

    texts: tuple[str, ...]
    features: FloatArray
    vectors: FloatArray
    moves: Moves

    @classmethod
    def standard(cls) -> Workload:
        """The inputs of ``motionrt bench``."""
        random = np.random.default_rng(0)
        features = random.normal(size=(WINDOW_FRAMES, guo263.WIDTH)).astype(np.float32)
        vectors = random.normal(size=(max(SEARCH_SIZES), 256)).astype(np.float32)
        vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
        return cls(TEXTS, features, vectors, Moves.standard())

    def gallery(self, model: str, fingerprint: str) -> Gallery:
        """10,000 clips with the first of the vectors, as if that model had made them."""
        count = 10_000
        clips = tuple(Clip(f"{number:05d}", 10.0) for number in range(count))
        windows = window_table([[(0.0, 10.0)]] * count)
        return Gallery(clips, self.vectors[:count], windows, ModelStamp(model, fingerprint))


def search_case(size: int) -> str:
    """Name of the search over ``size`` vectors."""
    return f"search {size:,}"


def search_call(vectors: FloatArray, query: FloatArray) -> Call:
    """One exact search."""
    index = ExactIndex(vectors)
    return lambda: index.nearest(query, TOP)
