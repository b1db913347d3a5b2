"""Diversity, multimodality and Frechet distance of generated motions  [Guo et al. 2022, 5.1].

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


def frechet_distance(found: npt.ArrayLike, recorded: npt.ArrayLike) -> float:
    """FID: Frechet distance of the normal distributions fitted to embeddings ``(N >= 2, d)`` and ``(M >= 2, d)``.

    ``|m - n|^2 + tr(A + B - 2 (A B)^(1/2))`` with means ``m, n`` and covariances ``A, B``; squared units of the
    embeddings. With fewer embeddings than dimensions it is biased upwards: compare sets of one size.
    """
    a, b = _checked(found, 2), _checked(recorded, 2)
    if a.shape[1] != b.shape[1]:
        raise InvalidInputError(f"embeddings must have one width, not {a.shape[1]} and {b.shape[1]}")
    apart = a.mean(axis=0) - b.mean(axis=0)
    left, right = ((points - points.mean(axis=0)) / np.sqrt(len(points) - 1) for points in (a, b))
    # the trace of (A B)^(1/2) is the sum of the singular values of left right^T, for A = left^T left, B = right^T right
    shared = np.linalg.svd(left @ right.T, compute_uv=False).sum()
    return float(apart @ apart + (left**2).sum() + (right**2).sum() - 2 * shared)


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
