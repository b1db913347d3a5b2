"""Moment retrieval: the window pyramid, suppression and the curve, by hand and on a planted moment."""

from __future__ import annotations

import numpy as np
import pytest
from fake_embedder import FakeEmbedder
from motions import random_motion, standing

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt.retrieval import find_moments, motion_features
from motionrt.retrieval.moments import non_maximum_suppression, pyramid, similarity_curve


def test_the_pyramid_slides_every_length_to_the_end_of_the_motion() -> None:
    assert pyramid(23, lengths=(10, 20, 40), stride=5).tolist() == [
        [0, 10], [5, 15], [10, 20], [13, 23], [0, 20], [3, 23],
    ]  # fmt: skip


def test_a_motion_shorter_than_every_window_is_one_window() -> None:
    assert pyramid(4).tolist() == [[0, 4]]


def test_suppression_keeps_the_best_of_every_overlapping_group() -> None:
    spans = np.array([[0, 10], [2, 12], [20, 30], [21, 31], [8, 18]])
    scores = np.array([0.5, 0.9, 0.3, 0.2, 0.8], dtype=np.float32)
    # 1 wins; 0 overlaps it by 8/12; 4 by 4/16 = 0.25, which is allowed; 2 beats 3 (overlap 9/11).
    assert non_maximum_suppression(spans, scores, 0.3) == [1, 4, 2]


def test_empty_spans_end_the_suppression_too() -> None:
    spans, scores = np.array([[0, 0], [0, 0]]), np.array([1, 1], dtype=np.float32)
    assert non_maximum_suppression(spans, scores) == [0, 1]


def test_the_curve_is_the_mean_over_the_windows_of_a_frame() -> None:
    spans, scores = np.array([[0, 2], [1, 4]]), np.array([0.2, 0.6], dtype=np.float32)
    np.testing.assert_allclose(similarity_curve(spans, scores, 5), [0.2, 0.4, 0.6, 0.6, 0.0], atol=1e-6)


def test_a_moment_planted_in_a_long_motion_is_found() -> None:
    still, busy = standing(80), random_motion(40)
    rotations = np.concatenate([still.rotations, busy.rotations, still.rotations])
    root = np.concatenate([still.root, busy.root, np.tile(busy.root[-1], (80, 1))])
    features, model = motion_features(Motion(rotations, root, 20.0)), FakeEmbedder()
    query = model.embed_motion([guo263.part(features, 85, 115)])[0]
    found = find_moments(query, features, model, k=3)
    assert (found.best[0].start_s, found.best[0].end_s) == (4.25, 5.75)
    assert found.best[0].score == pytest.approx(1.0, abs=1e-5)
    assert [moment.rank for moment in found.best] == [1, 2, 3]
    assert 80 <= int(found.curve.argmax()) < 120


def test_bad_windows_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least one frame"):
        pyramid(100, lengths=(), stride=5)
