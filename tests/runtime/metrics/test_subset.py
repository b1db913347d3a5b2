"""Protocol (c): which texts are least alike."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motionrt import metrics
from motionrt.errors import InvalidInputError


def similarities(seed: int, count: int) -> np.ndarray:
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return metrics.text_scores(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def total(matrix: np.ndarray, chosen: np.ndarray) -> float:
    return sum(float(matrix[a, b]) for a, b in combinations(chosen.tolist(), 2))


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.integers(2, 9), data=st.data())
def test_the_knapsack_is_close_to_the_best_of_all_subsets_and_no_swap_helps(seed: int, count: int, data) -> None:
    size, matrix = data.draw(st.integers(1, count)), similarities(seed, count)
    chosen = metrics.least_similar_sum(matrix, size)
    assert len(set(chosen.tolist())) == size
    assert sorted(chosen.tolist()) == chosen.tolist()
    best = min(total(matrix, np.array(subset)) for subset in combinations(range(count), size))
    assert total(matrix, chosen) <= best * 1.1 + 1e-6
    for leaves in chosen:
        for enters in set(range(count)) - set(chosen.tolist()):
            swapped = np.array([enters if one == leaves else one for one in chosen])
            assert total(matrix, swapped) >= total(matrix, chosen) - 1e-6


def test_protocol_c_takes_either_choice_and_sizes_below_one_are_refused() -> None:
    matrix = similarities(1, 8)
    for choose in (metrics.most_dissimilar, metrics.least_similar_sum):
        row = metrics.dissimilar_subset(np.eye(8), matrix, 3, choose)
        assert (row.text_to_motion.queries, row.text_to_motion.recall[1]) == (3, 100.0)
    with pytest.raises(InvalidInputError, match="at least 1"):
        metrics.least_similar_sum(matrix, 0)
