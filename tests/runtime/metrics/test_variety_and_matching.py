"""Diversity, multimodality and matching ranks against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import sqrtm
from scipy.stats import hypergeom

from motionrt import metrics
from motionrt.errors import InvalidInputError


def test_two_motions_are_as_diverse_as_they_are_apart() -> None:
    assert metrics.diversity([[0.0, 0.0], [3.0, 4.0]]) == pytest.approx(5)


def test_diversity_tends_to_the_mean_distance_of_all_pairs_and_is_fixed_by_its_seed() -> None:
    points = np.random.default_rng(3).normal(size=(40, 6))
    distances = np.linalg.norm(points[:, None] - points[None], axis=-1)
    expected = distances.sum() / (40 * 39)
    assert metrics.diversity(points, pairs=100_000) == pytest.approx(expected, rel=0.01)
    assert metrics.diversity(points) == metrics.diversity(points) != metrics.diversity(points, seed=1)


def test_multimodality_looks_only_within_a_text() -> None:
    texts = np.array([[[0.0], [2.0]], [[100.0], [106.0]]])  # distances 2 and 6, whatever is drawn
    assert metrics.multimodality(texts) == pytest.approx(4)
    assert metrics.multimodality(np.ones((3, 5, 2))) == 0
    assert metrics.diversity(texts.reshape(-1, 1)) > 20


@pytest.mark.parametrize(
    "call",
    [
        lambda: metrics.diversity(np.zeros((1, 4))),
        lambda: metrics.multimodality(np.zeros((3, 1, 4))),
        lambda: metrics.multimodality(np.zeros((3, 4))),
        lambda: metrics.diversity(np.array([[np.nan], [0.0]])),
        lambda: metrics.diversity(np.zeros((3, 4)), pairs=0),
    ],
)
def test_too_few_or_broken_embeddings_are_refused(call) -> None:
    with pytest.raises(InvalidInputError):
        call()


def test_all_texts_compete_when_there_are_no_more_than_a_batch() -> None:
    similarity = [[0.9, 0.1, 0.2], [0.3, 0.8, 0.1], [0.5, 0.6, 0.4], [0.0, 0.0, 0.0]]
    found = metrics.matching_ranks(similarity, [0, 0, 2, 1], repeats=2)
    assert found.tolist() == [[1, 1], [2, 2], [3, 3], [3, 3]]  # ties count against the motion


def test_a_batch_of_some_texts_ranks_as_the_hypergeometric_law_says() -> None:
    similarity = np.zeros((1, 40))
    similarity[0, :6], similarity[0, 6] = 1.0, 0.5  # six of the 39 other texts stand before the right one
    found = metrics.matching(similarity, [6], among=32, repeats=20_000)
    law = hypergeom(39, 6, 31)
    assert found.recall[3] == pytest.approx(100 * law.cdf(2), abs=1)
    assert found.recall[5] == pytest.approx(100 * law.cdf(4), abs=1)
    assert found.queries == 20_000


def test_chance_ranks_one_in_thirty_two_first() -> None:
    found = metrics.chance()
    assert (found.recall[1], found.recall[3], found.median_rank) == pytest.approx((3.125, 9.375, 16.5))
    random = np.random.default_rng(0).normal(size=(300, 40))
    measured = metrics.matching(random, np.arange(300) % 40)
    assert measured.recall[1] == pytest.approx(found.recall[1], abs=1.5)


@pytest.mark.parametrize(
    ("similarity", "right"),
    [
        (np.zeros((2, 3)), [0]),
        (np.zeros((2, 3)), [0, 3]),
        (np.zeros((2, 3)), [0.0, 1.0]),
        (np.full((2, 3), np.nan), [0, 1]),
    ],
)
def test_ranks_without_a_right_text_are_refused(similarity, right) -> None:
    with pytest.raises(InvalidInputError):
        metrics.matching_ranks(similarity, right)


def test_the_frechet_distance_is_that_of_the_matrix_square_root() -> None:
    random = np.random.default_rng(3)
    a, b = random.normal(0, 1, (60, 5)) @ random.normal(0, 1, (5, 5)), random.normal(0.5, 2, (40, 5))
    first, second = np.cov(a.T), np.cov(b.T)
    apart = ((a.mean(axis=0) - b.mean(axis=0)) ** 2).sum()
    expected = apart + np.trace(first + second - 2 * sqrtm(first @ second).real)
    assert metrics.frechet_distance(a, b) == pytest.approx(expected, rel=1e-6)
    assert metrics.frechet_distance(a, a) == pytest.approx(0, abs=1e-9)
    assert metrics.frechet_distance(a + 2, a) == pytest.approx(4 * 5)
    with pytest.raises(InvalidInputError, match="width"):
        metrics.frechet_distance(a, b[:, :3])


def test_the_energy_of_a_motion_is_the_speed_of_its_joints_about_the_root() -> None:
    time = np.arange(31) / 30
    root = np.stack([time, 0 * time, 0 * time], axis=1)
    arm = root + np.stack([0 * time, 2 * time, 0 * time], axis=1)
    joints = np.stack([root, *[arm] * 11, *[root] * 12], axis=1)
    assert metrics.motion_energy(joints, 30) == pytest.approx(2 * 11 / 23)
