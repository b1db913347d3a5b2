"""False negatives are dropped by text similarity, unless a side or a direction differs."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt_training.text_filter import directions, keep_negatives


def kept(first: str, second: str, cosine: float, threshold: float | None = 0.8) -> bool:
    embeddings = np.array([[1.0, 0.0], [cosine, np.sqrt(1.0 - cosine**2)]], dtype=np.float32)
    keep = keep_negatives(embeddings, [directions(first), directions(second)], threshold)
    assert keep[0, 0]
    assert keep[1, 1]
    assert keep[0, 1] == keep[1, 0]
    return bool(keep[0, 1])


@pytest.mark.parametrize(("cosine", "stays"), [(0.59, True), (0.61, False), (0.99, False)])
def test_the_threshold_of_the_unit_scale_is_cosine_six_tenths(cosine: float, stays: bool) -> None:
    assert kept("a man walks", "somebody walks", cosine) is stays


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("walks forward and turns left", "walks forward and turns right"),
        ("circles clockwise", "circles counterclockwise"),
        ("circles clockwise", "circles counter-clockwise"),
        ("steps forward", "steps backwards"),
        ("walks upstairs", "walks downstairs"),
        ("raises the left arm", "raises both arms"),
        ("A right-handed throw.", "A left-handed throw."),
        ("walks and turns left", "walks and turns"),
    ],
)
def test_other_sides_or_directions_stay_negatives(first: str, second: str) -> None:
    assert kept(first, second, 0.97)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("walks forward", "strides forwards"),
        ("turns anti-clockwise", "turns counterclockwise"),
        ("Left!", "leftwards"),
    ],
)
def test_the_same_direction_in_other_words_is_dropped(first: str, second: str) -> None:
    assert not kept(first, second, 0.9)


def test_without_a_threshold_everything_stays() -> None:
    assert kept("walks", "walks", 1.0, None)


def test_directions_can_be_disregarded() -> None:
    same = np.array([[1.0, 0.0], [1.0, 0.0]], dtype=np.float32)
    groups = [directions("left"), directions("right")]
    assert not keep_negatives(same, groups, 0.8, respect_directions=False)[0, 1]


def test_a_word_that_only_contains_a_direction_says_nothing() -> None:
    assert directions("a bright upper cupboard") == frozenset()
