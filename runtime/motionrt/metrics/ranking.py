"""Ranks, recall at k and median rank of a similarity matrix  [TMR 4.1]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError

Floats = npt.NDArray[np.floating[Any]]
RECALL_AT = (1, 2, 3, 5, 10)


@dataclass(frozen=True)
class Scores:
    """Retrieval in one direction.

    Attributes:
        recall: percent of queries whose rank is at most k, for every k of :data:`RECALL_AT`.
        median_rank: MedR, 1 is best.
        queries: how many queries were ranked.
    """

    recall: dict[int, float]
    median_rank: float
    queries: int


@dataclass(frozen=True)
class Retrieval:
    """Retrieval in both directions, as the rows of TMR's tables."""

    text_to_motion: Scores
    motion_to_text: Scores


def checked_similarity(similarity: npt.ArrayLike) -> Floats:
    """``similarity`` as a square float matrix of finite numbers; InvalidInputError otherwise."""
    matrix = np.asarray(similarity)
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not len(matrix):
        raise InvalidInputError(f"similarity must be a square matrix of pairs, not {matrix.shape}")
    if not np.issubdtype(matrix.dtype, np.floating):
        matrix = matrix.astype(np.float64)
    if not np.isfinite(matrix).all():
        raise InvalidInputError("similarity holds a number that is not finite")
    return matrix


def ranks(similarity: npt.ArrayLike, correct: npt.ArrayLike | None = None) -> npt.NDArray[np.int64]:
    """Rank, from 1, of the best correct item of every query.

    Ties count against the model: an item with the same similarity as the correct one stands before it, so a
        model
    that scores everything alike is last everywhere.

    Args:
        similarity: ``(N, N)``; row i are the similarities of query i with every item.
        correct: ``(N, N)`` bool, True where the item is an answer to the query; by default the diagonal.

    Returns:
        ``(N,)`` int64.
    """
    matrix = checked_similarity(similarity)
    right = np.eye(len(matrix), dtype=bool) if correct is None else np.asarray(correct, dtype=bool)
    if right.shape != matrix.shape or not right.any(axis=1).all():
        raise InvalidInputError(f"correct must be {matrix.shape} with at least one correct item for every query")
    best = np.where(right, matrix, -np.inf).max(axis=1, keepdims=True)
    return np.asarray(1 + ((matrix >= best) & ~right).sum(axis=1), dtype=np.int64)


def scores(query_ranks: npt.ArrayLike, at: Sequence[int] = RECALL_AT) -> Scores:
    """Recall at k in percent and the median of ranks ``(N,)``."""
    values = np.asarray(query_ranks)
    if values.ndim != 1 or not len(values):
        raise InvalidInputError("ranks must be a vector with at least one rank")
    recall = {k: 100.0 * float((values <= k).mean()) for k in at}
    return Scores(recall, float(np.median(values)), len(values))


def retrieval(similarity: npt.ArrayLike, correct: npt.ArrayLike | None = None) -> Retrieval:
    """Both directions of ``similarity`` ``(N texts, N motions)``; ``correct`` as in :func:`ranks`."""
    matrix = checked_similarity(similarity)
    right = None if correct is None else np.asarray(correct, dtype=bool)
    back = None if right is None else right.T
    return Retrieval(scores(ranks(matrix, right)), scores(ranks(matrix.T, back)))


def text_scores(sentence_embeddings: npt.ArrayLike) -> Floats:
    """Text similarity on the [0, 1] scale, ``(1 + cosine) / 2``, ``(N, N)``, of unit sentence embeddings
    ``(N, d)``.
    """
    unit = np.asarray(sentence_embeddings)
    if unit.ndim != 2 or not len(unit):
        raise InvalidInputError(f"sentence embeddings must have the shape (N, d), not {unit.shape}")
    return np.asarray((1 + np.clip(unit @ unit.T, -1, 1)) / 2)
