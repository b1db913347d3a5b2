"""Does a motion look like its own text more than like others? Ranks among a random batch  [Guo et al. 2022, 5.1]."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.metrics.ranking import Floats, Scores, scores

AMONG = 32


def matching_ranks(
    similarity: npt.ArrayLike, right: npt.ArrayLike, among: int = AMONG, repeats: int = 100, seed: int = 0
) -> npt.NDArray[np.int64]:
    """Rank, from 1, of the right text of every motion among ``among`` texts; the others are drawn anew every time.

    Ties count against the motion. Unlike :func:`motionrt.metrics.small_batches`, many motions may share a text.

    Args:
        similarity: ``(M motions, N texts)``.
        right: ``(M,)`` which text each motion is of.
        among: texts of a batch, the right one included; all N, where there are fewer.
        repeats: batches that every motion is ranked in.
        seed: of the draws.

    Returns:
        ``(M, repeats)`` int64.
    """
    matrix, own = _checked(similarity, right, among, repeats)
    others = min(among, matrix.shape[1]) - 1
    generator = np.random.default_rng(seed)
    lead = matrix >= matrix[np.arange(len(matrix)), own][:, None]
    return np.stack([_ranks(lead[row], own[row], others, repeats, generator) for row in range(len(matrix))])


def matching(
    similarity: npt.ArrayLike, right: npt.ArrayLike, among: int = AMONG, repeats: int = 100, seed: int = 0
) -> Scores:
    """Recall at k and median rank over all motions and batches of :func:`matching_ranks`."""
    return scores(matching_ranks(similarity, right, among, repeats, seed).ravel())


def chance(among: int = AMONG) -> Scores:
    """What ranking at random gives: every rank is as likely as the others."""
    if among < 1:
        raise InvalidInputError(f"among must be at least 1, not {among}")
    return scores(np.arange(1, among + 1))


def _ranks(
    lead: npt.NDArray[np.bool_], own: int, others: int, repeats: int, generator: np.random.Generator
) -> npt.NDArray[np.int64]:
    wrong = np.delete(lead, own)
    return np.array([1 + generator.permutation(wrong)[:others].sum() for _ in range(repeats)], dtype=np.int64)


def _checked(
    similarity: npt.ArrayLike, right: npt.ArrayLike, among: int, repeats: int
) -> tuple[Floats, npt.NDArray[np.int64]]:
    matrix, own = np.asarray(similarity, dtype=np.float64), np.asarray(right)
    if matrix.ndim != 2 or not matrix.size or not np.isfinite(matrix).all():
        raise InvalidInputError(f"similarity must be finite, (motions, texts), not {matrix.shape}")
    if own.shape != matrix.shape[:1] or not np.issubdtype(own.dtype, np.integer):
        raise InvalidInputError(f"right must name one text for each of {len(matrix)} motions, not {own.shape}")
    if own.min() < 0 or own.max() >= matrix.shape[1]:
        raise InvalidInputError(f"right names a text that is none of the {matrix.shape[1]}")
    if among < 1 or repeats < 1:
        raise InvalidInputError("among and repeats must be at least 1")
    return matrix, own.astype(np.int64)
