"""Names over the figures: none lies upon another in the picture, and the ends of long ones are left away."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.studio.titles import LINE_PIXELS, lifts, short, width

EYE, TARGET, FOV, HEIGHT = np.array([1.0, 2.0, 12.0]), np.array([0.0, 1.0, 0.0]), 0.9, 900.0
place = st.tuples(st.floats(-4, 4), st.floats(1, 2), st.floats(-4, 4))


def picture(places: np.ndarray) -> np.ndarray:
    """``(N, 2)`` pixels from the middle, right and up, by a look-at matrix of its own."""
    z = (EYE - TARGET) / np.linalg.norm(EYE - TARGET)
    x = np.cross([0, 1, 0], z) / np.linalg.norm(np.cross([0, 1, 0], z))
    seen = (places - EYE) @ np.stack([x, np.cross(z, x), z]).T
    return seen[:, :2] / -seen[:, 2:] * HEIGHT / 2 / math.tan(FOV / 2)


@given(st.lists(st.tuples(place, st.floats(30, 200)), min_size=2, max_size=7))
def test_no_two_names_overlap_in_the_picture_and_none_goes_down(
    rows: list[tuple[tuple[float, float, float], float]],
) -> None:
    places, widths = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    up = lifts(places, widths, EYE, TARGET, FOV, HEIGHT)
    assert (up >= 0).all()
    shown = picture(places + up[:, None] * [0, 1, 0])
    slack = 0.25 * LINE_PIXELS  # the camera looks down: what goes up in the world goes a little aside, too
    for one in range(len(rows)):
        for other in range(one):
            aside = abs(shown[one, 0] - shown[other, 0]) >= (widths[one] + widths[other]) / 2 - slack
            above = abs(shown[one, 1] - shown[other, 1]) >= LINE_PIXELS - slack
            assert aside or above


def test_names_that_are_apart_stay_where_they_are() -> None:
    places = np.array([[-3.0, 1.7, 0.0], [3.0, 1.7, 0.0], [0.0, 1.7, 30.0]])  # the last is behind the camera
    assert not lifts(places, np.full(3, 60.0), EYE, TARGET, FOV, HEIGHT).any()


@pytest.mark.parametrize(
    ("name", "figures", "shown"),
    [
        ("1. a person walks in a circle to the right", 2, "1. a person walks in a circle to the right"),
        ("1. a person walks in a circle to the right", 6, "1. a person walks in a…"),
        ("12345678901234567890_a_name_without_a_blank_in_it", 6, "12345678901234567890_a_…"),
    ],
)
def test_a_long_name_is_cut_between_words_and_shorter_over_many(name: str, figures: int, shown: str) -> None:
    assert short(name, figures) == shown
    assert width(shown) > width("walk")
