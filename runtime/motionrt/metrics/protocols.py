"""The four evaluation protocols of TMR 4.1: (a) all, (b) all with threshold, (c) dissimilar subset, (d) small
batches.

``similarity`` is always ``(N texts, N motions)`` with the pairs on its diagonal, and ``text_similarity`` is
``(N, N)`` between the texts on the [0, 1] scale (:func:`motionrt.metrics.text_scores`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.metrics.ranking import (
    RECALL_AT,
    Floats,
    Retrieval,
    Scores,
    checked_similarity,
    retrieval,
)

Choice = Callable[[npt.ArrayLike, int], npt.NDArray[np.int64]]
"""Similarity of texts and a number -> the indices, ascending, of so many texts."""

_STARTS = 12  # sets that grow, and as many that shrink


def all_pairs(similarity: npt.ArrayLike) -> Retrieval:
    """Protocol (a): the whole set as the gallery, only the paired item is correct."""
    return retrieval(similarity)


def all_with_threshold(similarity: npt.ArrayLike, text_similarity: npt.ArrayLike, threshold: float = 0.95) -> Retrieval:
    """Protocol (b): an item is correct, too, when its text is at least ``threshold`` similar to the query's
    text.
    """
    correct = checked_similarity(text_similarity) >= threshold
    return retrieval(similarity, correct | np.eye(len(correct), dtype=bool))


def dissimilar_subset(
    similarity: npt.ArrayLike, text_similarity: npt.ArrayLike, size: int = 100, choose: Choice | None = None
) -> Retrieval:
    """Protocol (c): only the ``size`` pairs (all, when there are fewer) whose texts are least alike.

    ``choose`` says which these are: :func:`most_dissimilar` by default, :func:`least_similar_sum` as in the paper.
    """
    chosen = (choose or most_dissimilar)(text_similarity, size)
    return retrieval(checked_similarity(similarity)[np.ix_(chosen, chosen)])


def small_batches(similarity: npt.ArrayLike, batch: int = 32, repeats: int = 10, seed: int = 0) -> Retrieval:
    """Protocol (d): every pair competes only inside a random batch of ``batch`` pairs.

    The set is shuffled ``repeats`` times with ``seed``; recall and median rank are means over all full
    batches. The rest that does not fill a batch sits out of that shuffle (another shuffle draws another
    rest); a set smaller than ``batch`` is one batch.
    """
    matrix = checked_similarity(similarity)
    if batch < 1 or repeats < 1:
        raise InvalidInputError("batch and repeats must be at least 1")
    size, generator = min(batch, len(matrix)), np.random.default_rng(seed)
    rows = []
    for _ in range(repeats):
        order = generator.permutation(len(matrix))
        starts = range(0, len(matrix) - size + 1, size)
        rows += [retrieval(matrix[np.ix_(part, part)]) for part in (order[s : s + size] for s in starts)]
    return Retrieval(
        _mean([row.text_to_motion for row in rows]),
        _mean([row.motion_to_text for row in rows]),
    )


def most_dissimilar(text_similarity: npt.ArrayLike, size: int = 100) -> npt.NDArray[np.int64]:
    """Indices, ascending, of ``size`` texts that are least alike: farthest-point sampling, greedy, no
    randomness.

    It starts with the text that is least similar to all others on average; each further step takes the text
    whose most similar chosen text is least similar to it. Ties go to the lower index.
    """
    matrix = checked_similarity(text_similarity)
    if size < 1:
        raise InvalidInputError(f"size must be at least 1, not {size}")
    closest = np.full(len(matrix), -np.inf)
    chosen = [int(np.argmin(_others_mean(matrix)))]
    while len(chosen) < min(size, len(matrix)):
        closest = np.maximum(closest, matrix[chosen[-1]])
        closest[chosen[-1]] = np.inf
        chosen.append(int(np.argmin(closest)))
    return np.sort(np.array(chosen, dtype=np.int64))


def least_similar_sum(text_similarity: npt.ArrayLike, size: int = 100) -> npt.NDArray[np.int64]:
    """Indices, ascending, of ``size`` texts whose similarities to each other have the smallest sum.

    This is the quadratic knapsack problem of the paper with equal weights, solved approximately. From several sets the
    swap of a text inside with one outside that lowers the sum most is made until there is none; the best of the ends
    is taken. Some starts are what is left after the text that is most like the others has left again and again, one
    each of the likest having left first; others grow from the texts that are least like all, each time by the text
    least like the set. Deterministic; ties go to the lower index.
    """
    matrix = checked_similarity(text_similarity)
    if size < 1:
        raise InvalidInputError(f"size must be at least 1, not {size}")
    pairs = (matrix + matrix.T) / 2
    np.fill_diagonal(pairs, 0.0)
    order = np.argsort(pairs.sum(axis=1), kind="stable").tolist()
    starts = [_grown(pairs, text, size) for text in order[:_STARTS]]
    starts += [_shrunk(pairs, text, size) for text in order[-_STARTS:]] if size < len(pairs) else []
    ends = [_swapped(pairs, inside) for inside in starts]
    best = min(ends, key=lambda inside: float(pairs[np.ix_(inside, inside)].sum()))
    return np.flatnonzero(best).astype(np.int64)


def _shrunk(pairs: Floats, first: int, size: int) -> npt.NDArray[np.bool_]:
    """Who is left when a text leaves, and then the one most like the others until `size` are left."""
    inside = np.ones(len(pairs), dtype=bool)
    inside[first] = False
    sums = pairs.sum(axis=1) - pairs[first]
    while inside.sum() > size:
        leaves = int(np.argmax(np.where(inside, sums, -np.inf)))
        inside[leaves] = False
        sums -= pairs[leaves]
    return inside


def _grown(pairs: Floats, first: int, size: int) -> npt.NDArray[np.bool_]:
    """A text, and one after another those least like the set until there are `size`."""
    inside = np.zeros(len(pairs), dtype=bool)
    inside[first] = True
    sums = pairs[first].copy()
    while inside.sum() < min(size, len(pairs)):
        enters = int(np.argmin(np.where(inside, np.inf, sums)))
        inside[enters] = True
        sums += pairs[enters]
    return inside


def _swapped(pairs: Floats, inside: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """The set after all swaps that lower its sum."""
    sums = pairs[inside].sum(axis=0)
    while (swap := _best_swap(pairs, sums, inside)) is not None:
        leaves, enters = swap
        inside[leaves], inside[enters] = False, True
        sums += pairs[enters] - pairs[leaves]
    return inside


def _best_swap(pairs: Floats, sums: Floats, inside: npt.NDArray[np.bool_]) -> tuple[int, int] | None:
    """Who leaves and who enters so that the sum falls most; None where no swap lowers it."""
    within, without = np.flatnonzero(inside), np.flatnonzero(~inside)
    if not len(without):
        return None
    gains = sums[without][None] - sums[within][:, None] - pairs[np.ix_(within, without)]
    best = np.unravel_index(int(np.argmin(gains)), gains.shape)
    return (int(within[best[0]]), int(without[best[1]])) if gains[best] < -1e-9 else None


def _others_mean(matrix: Floats) -> Floats:
    return np.asarray((matrix.sum(axis=1) - np.diag(matrix)) / max(len(matrix) - 1, 1))


def _mean(rows: list[Scores]) -> Scores:
    recall = {k: float(np.mean([row.recall[k] for row in rows])) for k in RECALL_AT}
    return Scores(recall, float(np.mean([row.median_rank for row in rows])), sum(row.queries for row in rows))
