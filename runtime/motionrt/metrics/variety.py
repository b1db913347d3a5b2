"""Diversity and multimodality of generated motions  [Guo et al. 2022, 5.1].

Embeddings are those of one motion encoder, ``(..., d)``; distances are Euclidean, in its units. The draws are fixed by
a seed, so that the same embeddings give the same figure.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError

Floats = npt.NDArray[np.float64]

DIVERSITY_PAIRS = 300
MULTIMODALITY_PAIRS = 10


def diversity(embeddings: npt.ArrayLike, pairs: int = DIVERSITY_PAIRS, seed: int = 0) -> float:
    """Mean distance between ``pairs`` random pairs of two different motions ``(N >= 2, d)``, whatever their texts."""
    points = _checked(embeddings, 2)
    return float(_distances(points, pairs, np.random.default_rng(seed)).mean())


def multimodality(embeddings: npt.ArrayLike, pairs: int = MULTIMODALITY_PAIRS, seed: int = 0) -> float:
    """Mean distance between motions of one text, mean over texts, of ``(texts, motions of each >= 2, d)``.

    ``pairs`` pairs of two different motions are drawn for every text. (The paper draws two subsets of its 30 motions a
    text, in which a motion may meet itself; with few motions that would pull the figure towards zero.)
    """
    points, generator = _checked(embeddings, 3), np.random.default_rng(seed)
    return float(np.mean([_distances(group, pairs, generator).mean() for group in points]))


def _distances(points: Floats, pairs: int, generator: np.random.Generator) -> Floats:
    """``(pairs,)`` distances between two different rows of ``(N, d)`` each."""
    if pairs < 1:
        raise InvalidInputError(f"pairs must be at least 1, not {pairs}")
    first = generator.integers(len(points), size=pairs)
    second = (first + generator.integers(1, len(points), size=pairs)) % len(points)
    return np.asarray(np.linalg.norm(points[first] - points[second], axis=1))


def _checked(embeddings: npt.ArrayLike, axes: int) -> Floats:
    points = np.asarray(embeddings, dtype=np.float64)
    if points.ndim != axes or points.shape[-2] < 2 or not points.size:
        wanted = "(N >= 2, d)" if axes == 2 else "(texts, motions of each >= 2, d)"
        raise InvalidInputError(f"embeddings must have the shape {wanted}, not {points.shape}")
    if not np.isfinite(points).all():
        raise InvalidInputError("embeddings hold a number that is not finite")
    return points
