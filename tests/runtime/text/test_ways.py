"""How high the pelvis is in time, as texts say it."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.text import headings_of_text, heights_of_text, parse_query, way_of_text

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


@pytest.mark.parametrize(
    "text", ["a person walks", "a person is sitting", "walk over and sit down", "walk and jump", "bow", ""]
)
def test_texts_that_stay_at_a_level_or_move_on_say_no_heights(text: str) -> None:
    assert heights_of_text(parse_query(text), TIMES) is None


@pytest.mark.parametrize(("text", "jumps"), [("jumps up", 1), ("jumps three times", 3), ("hops twice", 2)])
def test_a_pelvis_is_thrown_up_as_often_as_a_text_says(text: str, jumps: int) -> None:
    heights = heights_of_text(parse_query(text), TIMES)
    assert heights is not None
    up = heights > 1.0
    assert np.count_nonzero(up[1:] & ~up[:-1]) == jumps
    assert heights[0] == heights[-1] == pytest.approx(0.94, abs=0.02)


def test_a_jumping_pelvis_falls_as_things_fall() -> None:
    fine = np.arange(0, 4, 1 / 120)
    heights = heights_of_text(parse_query("jumps up"), fine)
    assert heights is not None
    top = int(np.argmax(heights))
    falling = np.diff(heights[top - 12 : top + 13], 2) * 120**2
    np.testing.assert_allclose(falling, -9.81, atol=0.5)


def test_a_zigzag_bends_to_both_sides_and_an_eight_comes_back() -> None:
    zigzag = headings_of_text(parse_query("walks in a zigzag"), TIMES)
    eight = headings_of_text(parse_query("walks a figure eight"), TIMES)
    assert zigzag is not None
    assert eight is not None
    assert zigzag.max() > 0.6 > -0.6 > zigzag.min()
    assert np.ptp(eight) > np.pi
    assert eight[-1] == pytest.approx(eight[0], abs=0.2)
    assert headings_of_text(parse_query("walks in a circle"), TIMES) is None


def test_who_goes_aside_or_backward_is_not_faster_than_feet_can_step() -> None:
    for text in ("strafes left", "walks backwards", "sidesteps"):
        length = way_of_text(parse_query(text), 4.0).length
        assert length is not None
        assert length[1] < 4.0
    assert way_of_text(parse_query("walks forward"), 4.0).length is None
