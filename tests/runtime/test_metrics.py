"""The papers' measures against cases worked by hand, and recall against a plain sort."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt import metrics
from motionrt.errors import InvalidInputError

# Three texts (rows) and three motions (columns). Row 0: its motion is best (rank 1); row 1: motion 2 is
# better (rank 2); row 2: both others are better (rank 3). Columns: ranks 1, 2, 2.
SIMILARITY = np.array([[0.9, 0.1, 0.8], [0.2, 0.5, 0.6], [0.7, 0.6, 0.3]])
TEXTS = np.array([[1.0, 0.4, 0.96], [0.4, 1.0, 0.5], [0.96, 0.5, 1.0]])


def test_ranks_count_the_items_before_the_pair_in_both_directions() -> None:
    assert metrics.ranks(SIMILARITY).tolist() == [1, 2, 3]
    assert metrics.ranks(SIMILARITY.T).tolist() == [1, 2, 3]


def test_recall_is_a_percentage_of_ranks_and_medr_their_median() -> None:
    found = metrics.scores([1, 1, 2, 4, 11, 30])
    assert found.recall == pytest.approx({1: 100 / 3, 2: 50.0, 3: 50.0, 5: 200 / 3, 10: 200 / 3})
    assert (found.median_rank, found.queries) == (3.0, 6)


def test_a_tie_counts_against_the_model() -> None:
    assert metrics.ranks(np.full((4, 4), 0.5)).tolist() == [4, 4, 4, 4]


def test_protocol_a_gives_both_directions() -> None:
    similarity = np.array([[0.9, 0.8, 0.1], [0.95, 0.7, 0.2], [0.1, 0.2, 0.3]])
    found = metrics.all_pairs(similarity)
    assert found.text_to_motion.recall[1] == pytest.approx(200 / 3)  # row ranks 1, 2, 1
    assert found.motion_to_text.recall[1] == pytest.approx(100 / 3)  # column ranks 2, 2, 1
    assert (found.text_to_motion.median_rank, found.motion_to_text.median_rank) == (1.0, 2.0)


def test_protocol_b_accepts_an_item_whose_text_says_the_same() -> None:
    # Texts 0 and 2 are 0.96 alike: for query 2, motion 0 (0.7) is correct and nothing stands before it.
    found = metrics.all_with_threshold(SIMILARITY, TEXTS)
    assert found.text_to_motion.recall == pytest.approx({1: 200 / 3, 2: 100.0, 3: 100.0, 5: 100.0, 10: 100.0})
    assert metrics.all_with_threshold(SIMILARITY, TEXTS, threshold=0.97) == metrics.all_pairs(SIMILARITY)


def test_protocol_b_keeps_a_pair_correct_whatever_the_text_similarity_says_of_itself() -> None:
    barely_unit = TEXTS * 0.94
    assert metrics.all_with_threshold(SIMILARITY, barely_unit) == metrics.all_pairs(SIMILARITY)


def test_the_dissimilar_subset_is_the_hand_worked_greedy_choice() -> None:
    # Mean similarity to the others: 0.4, 0.5, 0.3667, 0.4667 -> start at 2. Then the least similar to 2 is 3
    # (0.1); then, by the nearer of 2 and 3: item 0 max(0.3, 0.7) = 0.7, item 1 max(0.7, 0.6) = 0.7: a tie,
    # lower index.
    texts = np.array([[1, 0.2, 0.3, 0.7], [0.2, 1, 0.7, 0.6], [0.3, 0.7, 1, 0.1], [0.7, 0.6, 0.1, 1]])
    assert metrics.most_dissimilar(texts, 2).tolist() == [2, 3]
    assert metrics.most_dissimilar(texts, 3).tolist() == [0, 2, 3]
    assert metrics.most_dissimilar(texts, 100).tolist() == [0, 1, 2, 3]


def test_protocol_c_ranks_only_inside_the_subset() -> None:
    texts = np.array([[1, 0.9, 0.1], [0.9, 1, 0.2], [0.1, 0.2, 1]])
    found = metrics.dissimilar_subset(SIMILARITY, texts, size=2)  # pairs 0 and 2
    assert found.text_to_motion.queries == 2
    assert found.text_to_motion.recall[1] == 50.0  # [[0.9, 0.8], [0.7, 0.3]]: ranks 1 and 2
    assert found.motion_to_text.recall[1] == 50.0


def test_protocol_d_drops_the_rest_and_averages_over_seeded_shuffles() -> None:
    similarity = np.random.default_rng(3).normal(size=(70, 70))
    found = metrics.small_batches(similarity, repeats=4, seed=1)
    assert found.text_to_motion.queries == 4 * 2 * 32  # two full batches of 70, six pairs sit out
    assert found == metrics.small_batches(similarity, repeats=4, seed=1)
    assert found != metrics.small_batches(similarity, repeats=4, seed=2)


def test_protocol_d_of_chance_is_chance_and_of_a_perfect_model_perfect() -> None:
    chance = metrics.small_batches(np.random.default_rng(0).normal(size=(320, 320)), repeats=20)
    assert chance.text_to_motion.recall[1] == pytest.approx(100 / 32, abs=1.0)
    assert chance.text_to_motion.median_rank == pytest.approx(16.5, abs=1.5)
    perfect = metrics.small_batches(np.eye(40))
    assert perfect.motion_to_text.recall[1] == 100.0


def test_a_set_smaller_than_a_batch_is_one_batch() -> None:
    assert metrics.small_batches(SIMILARITY, repeats=1) == metrics.all_pairs(SIMILARITY)


def test_text_scores_map_cosines_onto_zero_to_one() -> None:
    embeddings = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    expected = [[1.0, 0.5, 0.0], [0.5, 1.0, 0.5], [0.0, 0.5, 1.0]]
    np.testing.assert_allclose(metrics.text_scores(embeddings), expected)


def test_temporal_iou_of_hand_worked_spans() -> None:
    found = metrics.temporal_iou([[0, 4], [0, 1], [2, 3], [1, 1]], [[2, 6], [1, 2], [0, 10], [1, 1]])
    np.testing.assert_allclose(found, [2 / 6, 0.0, 0.1, 0.0])


def test_temporal_iou_broadcasts_to_all_pairs() -> None:
    spans = np.array([[0.0, 2.0], [1.0, 3.0]])
    np.testing.assert_allclose(metrics.temporal_iou(spans[:, None], spans), [[1, 1 / 3], [1 / 3, 1]])


def test_localisation_accuracy_counts_overlaps_of_at_least_the_threshold() -> None:
    found, truth = [[0, 10], [0, 5], [0, 3], [5, 6]], [[0, 10], [0, 10], [0, 10], [0, 1]]
    assert metrics.localisation_accuracy(found, truth) == {0.3: 75.0, 0.5: 50.0, 0.7: 25.0}


@given(st.integers(1, 12), st.integers(0, 2**31))
def test_ranks_agree_with_a_plain_sort(size: int, seed: int) -> None:
    similarity = np.random.default_rng(seed).normal(size=(size, size))
    expected = [sorted(row, reverse=True).index(row[i]) + 1 for i, row in enumerate(similarity.tolist())]
    assert metrics.ranks(similarity).tolist() == expected


@pytest.mark.parametrize(
    "broken",
    [np.zeros((2, 3)), np.zeros((0, 0)), np.array([[np.nan]]), np.zeros(4)],
    ids=["not square", "empty", "not finite", "a vector"],
)
def test_a_similarity_that_is_no_matrix_of_pairs_is_refused(broken: np.ndarray) -> None:
    with pytest.raises(InvalidInputError, match="similarity"):
        metrics.ranks(broken)


def test_a_query_without_a_correct_item_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least one correct"):
        metrics.ranks(SIMILARITY, np.zeros((3, 3), dtype=bool))


def test_a_span_that_ends_before_it_starts_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="start first"):
        metrics.temporal_iou([2, 1], [0, 1])
