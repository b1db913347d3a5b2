"""Exact cosine search, the same answer every time."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray

IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Hit:
    """One answer to a query.

    Attributes:
        rank: 1 is best.
        score: cosine of text and motion, -1 to 1.
        id: the clip's name in its gallery: its path below the indexed folder, with forward slashes.
        path: the clip's file; ``None`` when the gallery carries the motion itself.
        start_s: where the found span starts in the clip, seconds.
        end_s: where it ends.
        text: what the gallery knows the clip to show, if anything.
    """

    rank: int
    score: float
    id: str
    path: Path | None
    start_s: float
    end_s: float
    text: str | None = None


class VectorIndex(Protocol):
    """A set of unit vectors that can be asked for the nearest; the place for other kinds of scan."""

    def __len__(self) -> int: ...

    def nearest(self, query: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
        """Indices and scores of the ``min(k, N)`` vectors nearest to ``query`` ``(d,)``, best first."""


class ExactIndex:
    """Every vector is compared, float32; equal vectors score equally, and stand in the order of their index.

    The product is an ``einsum``: a BLAS product of matrix and vector starts a thread on every core, waits for
        the
    slowest, and takes two to ten times as long (measured at 10,000 and 100,000 vectors).
    """

    def __init__(self, vectors: FloatArray) -> None:
        self._vectors = np.asarray(vectors)

    def __len__(self) -> int:
        return len(self._vectors)

    def nearest(self, query: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
        """See :class:`VectorIndex`."""
        return top(np.einsum("nd,d->n", self._vectors, query), k)


def top(scores: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
    """Indices and values of the ``min(k, N)`` largest scores ``(N,)``, best first, ties by index."""
    among = np.arange(len(scores))
    if k < len(scores):
        worst = np.partition(scores, len(scores) - k)[len(scores) - k]
        among = np.flatnonzero(scores >= worst)
    best = among[np.argsort(-scores[among], kind="stable")][:k]
    return best.astype(np.int64), scores[best]


def nearest_per_group(
    index: VectorIndex, query: FloatArray, k: int, group: npt.NDArray[np.integer]
) -> tuple[IntArray, FloatArray]:
    """As :meth:`VectorIndex.nearest`, but only the best of every group; ``group`` ``(N,)`` numbers them."""
    asked = k
    while True:
        found, scores = index.nearest(query, asked)
        _, first = np.unique(group[found], return_index=True)
        if len(first) >= k or asked >= len(index):
            kept = np.sort(first)[:k]
            return found[kept], scores[kept]
        asked *= 4


def checked_k(k: int) -> int:
    """``k`` as a whole number of at least 1; InvalidInputError otherwise."""
    try:
        value = operator.index(k)
    except TypeError:
        raise InvalidInputError(f"k must be a whole number, not {k!r}") from None
    if value < 1 or isinstance(k, bool):
        raise InvalidInputError(f"k must be at least 1, not {k!r}")
    return value
