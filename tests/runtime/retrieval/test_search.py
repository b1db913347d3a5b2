"""Exact search against a plain sort, ties, groups and odd values of k."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.retrieval.scores import top
from motionrt.retrieval.search import ExactIndex, checked_k, nearest_per_group


@given(st.lists(st.integers(-3, 3), min_size=1, max_size=40), st.integers(1, 50))
def test_top_is_a_stable_sort_of_all_scores(values: list[int], k: int) -> None:
    scores = np.array(values, dtype=np.float32)
    found, best = top(scores, k)
    expected = sorted(range(len(values)), key=lambda i: (-values[i], i))[:k]
    assert found.tolist() == expected
    assert best.tolist() == [values[i] for i in expected]


@given(st.integers(1, 60), st.integers(1, 12), st.integers(0, 2**31))
def test_nearest_per_group_is_the_best_of_every_group(size: int, k: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    vectors, query = (
        random.normal(size=(size, 4)).astype(np.float32),
        random.normal(size=4).astype(np.float32),
    )
    group = np.sort(random.integers(0, max(size // 4, 1), size))
    found, scores = nearest_per_group(ExactIndex(vectors), query, k, group)
    all_scores = np.einsum("nd,d->n", vectors, query)
    best = {int(g): max(all_scores[group == g]) for g in np.unique(group)}
    assert scores.tolist() == sorted(best.values(), reverse=True)[:k]
    assert [best[int(g)] for g in group[found]] == scores.tolist()


def test_a_large_index_answers_as_the_float64_product() -> None:
    random = np.random.default_rng(0)
    vectors = random.normal(size=(30_000, 256)).astype(np.float32)
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    query = vectors[123] + 0.01 * vectors[7]
    found, scores = ExactIndex(vectors).nearest(query, 10)
    exact = vectors.astype(np.float64) @ query.astype(np.float64)
    assert found.tolist() == np.argsort(-exact)[:10].tolist()
    np.testing.assert_allclose(scores, np.sort(exact)[::-1][:10], atol=1e-6)


def test_equal_vectors_score_equally_wherever_they_stand() -> None:
    vectors = np.random.default_rng(1).normal(size=(999, 256)).astype(np.float32)
    vectors[[3, 500, 998]] = vectors[0]
    found, scores = ExactIndex(vectors).nearest(vectors[0], 4)
    assert found.tolist() == [0, 3, 500, 998]
    assert len(set(scores.tolist())) == 1


@pytest.mark.parametrize("k", [0, -1, 1.5, "3", True, None])
def test_a_k_that_is_no_count_is_refused(k: object) -> None:
    with pytest.raises(InvalidInputError, match="k must be"):
        checked_k(k)  # type: ignore[arg-type]


def test_a_numpy_integer_is_a_count() -> None:
    assert checked_k(np.int64(3)) == 3  # type: ignore[arg-type]
