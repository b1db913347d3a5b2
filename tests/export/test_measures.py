"""Distances between outputs, worked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt_export.measures import beyond, measure, rounded, worst


def test_figures_of_two_rows() -> None:
    found = np.array([[3.0, 4.0], [1.0, 0.0]], np.float32)
    expected = np.array([[3.0, 4.0], [0.6, 0.8]], np.float32)
    figures = measure(found, expected)
    assert figures["cosine_min"] == pytest.approx(0.6)
    assert figures["max_abs_error"] == pytest.approx(0.8)
    assert figures["rms_error"] == pytest.approx(np.sqrt((0.16 + 0.64) / 4))


def test_only_valid_rows_count() -> None:
    found, expected = np.ones((1, 3, 2), np.float32), np.ones((1, 3, 2), np.float32)
    found[0, 2] = 100
    assert measure(found, expected, np.array([[True, True, False]]))["max_abs_error"] == 0


def test_errors_are_counted_in_units_of_the_scale() -> None:
    found, expected = np.array([[1.0, 10.0]]), np.array([[0.0, 0.0]])
    assert measure(found, expected, scale=np.array([1.0, 100.0]))["max_abs_error"] == pytest.approx(1.0)


def test_the_worst_is_the_smallest_cosine_and_the_largest_error() -> None:
    one = {"y": {"cosine_min": 0.9, "max_abs_error": 0.1}}
    two = {"y": {"cosine_min": 0.8, "max_abs_error": 0.05}}
    assert worst([one, two]) == {"y": {"cosine_min": 0.8, "max_abs_error": 0.1}}


def test_what_breaks_the_tolerance_is_told() -> None:
    figures = {"y": {"cosine_min": 0.98, "max_abs_error": 0.1}}
    assert beyond(figures, {"y": {"cosine_min": 0.97, "max_abs_error": 0.1}}) == []
    assert beyond(figures, {"y": {"cosine_min": 0.99}}) == ["y: cosine_min is 0.98, must be at least 0.99"]
    assert beyond(figures, {"y": {"max_abs_error": 0.01}}) == ["y: max_abs_error is 0.1, must be at most 0.01"]


def test_nan_is_never_within_tolerance() -> None:
    assert beyond({"y": {"max_abs_error": float("nan")}}, {"y": {"max_abs_error": 1.0}})
    assert beyond({"y": {"cosine_min": float("nan")}}, {"y": {"cosine_min": 0.0}})


def test_figures_are_rounded_to_the_worse_side() -> None:
    figures = {"y": {"cosine_min": 0.99999, "max_abs_error": 1.234e-5, "rms_error": 0.0}}
    assert rounded(figures) == {"y": {"cosine_min": 0.9999, "max_abs_error": 1.3e-5, "rms_error": 0.0}}
