"""Scores of vectors against a query, and the best of them, the same every time."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.vectors import Stored, Vectors, chunks

IntArray = npt.NDArray[np.int64]


def scores(vectors: Vectors, query: FloatArray) -> FloatArray:
    """The float32 scores of ``vectors`` ``(N, d)``, each the same whichever others stand beside it.

    The product is an ``einsum``: a BLAS product of matrix and vector starts a thread on every core, waits for the
    slowest, and takes two to ten times as long (measured at 10,000 and 100,000 vectors).
    """
    if isinstance(vectors, Stored):
        parts = [scores(part, query) for part in chunks(vectors)]
        return np.concatenate(parts) if parts else np.zeros(0, np.float32)
    result: FloatArray = np.einsum("nd,d->n", vectors, query)
    return result


def top(scores: FloatArray, k: int) -> tuple[IntArray, FloatArray]:
    """Indices and values of the ``min(k, N)`` largest scores ``(N,)``, best first, ties by index."""
    among = np.arange(len(scores))
    if k < len(scores):
        worst = np.partition(scores, len(scores) - k)[len(scores) - k]
        among = np.flatnonzero(scores >= worst)
    best = among[np.argsort(-scores[among], kind="stable")][:k]
    return best.astype(np.int64), scores[best]
