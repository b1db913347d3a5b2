"""How high the pelvis is in time, as texts say it."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.text import heights_of_text, parse_query

TIMES = np.arange(80) / 20


@pytest.mark.parametrize(
    ("text", "start", "end"),
    [
        ("a person sits down on a chair", 0.94, 0.5),
        ("someone takes a seat", 0.94, 0.5),
        ("a figure lowers itself into a seat", 0.94, 0.5),
        ("a man goes down on his knees", 0.94, 0.44),
        ("gets down on hands and knees", 0.94, 0.45),
        ("a person lies down on the floor", 0.94, 0.09),
        ("a person stands up from a chair", 0.5, 0.94),
        ("a man gets up from the floor", 0.3, 0.94),
    ],
)
def test_heights_go_from_where_a_text_begins_to_where_it_ends(text: str, start: float, end: float) -> None:
    heights = heights_of_text(parse_query(text), TIMES)
    assert heights is not None
    assert (heights[0], heights[-1]) == (pytest.approx(start, abs=0.02), pytest.approx(end, abs=0.02))
    assert (np.diff(heights) * (end - start) >= 0).all()


@pytest.mark.parametrize("text", ["a person squats down", "crouch down then rise", "sits on a chair, then stands up"])
def test_who_goes_down_and_up_is_low_in_between(text: str) -> None:
    heights = heights_of_text(parse_query(text), TIMES)
    assert heights is not None
    assert min(heights[0], heights[-1]) > 0.9
    assert heights.min() < 0.62


@pytest.mark.parametrize("text", ["a person walks", "a person is sitting", "walk over and sit down", "jump", "bow", ""])
def test_texts_that_stay_at_a_level_or_move_on_say_no_heights(text: str) -> None:
    assert heights_of_text(parse_query(text), TIMES) is None
