"""Timelines: which text holds when, and for which parts of the body."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.models.text import SentenceFeatures
from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.canvas import Words
from motionrt.synthesis.timeline import Line, pieces, read_timeline

ARM = frozenset({"right arm"})


def label(text: str) -> frozenset[str]:
    return ARM if "wave" in text else frozenset()


def words(text: str, seconds: float) -> Words:
    return Words(
        SentenceFeatures(np.zeros((1, 1, 384)), np.ones((1, 1), np.int64), np.zeros(384)), np.zeros(21, np.int64)
    )


def weights(lines: tuple[Line, ...]) -> list[np.ndarray]:
    """(frames, 6) of every piece, over the whole timeline."""
    found, frames = pieces(lines, words)
    rows = []
    for piece in found:
        whole = np.zeros((frames, len(PARTS)))
        whole[piece.first : piece.first + len(piece.weight)] = piece.weight
        rows.append(whole)
    return rows


def test_texts_without_times_follow_one_another() -> None:
    lines = read_timeline(["walk forward", ("sit down", 2)], label)
    assert [(line.start, line.end, line.parts) for line in lines] == [(0, 4, None), (4, 6, None)]


def test_a_text_upon_another_gets_the_parts_that_it_needs() -> None:
    lines = read_timeline([("walk", 4), {"text": "wave", "from": 1, "to": 3}], label)
    assert lines[1] == Line("wave", 1, 3, ARM)


def test_parts_that_are_given_are_kept() -> None:
    lines = read_timeline([("walk", 4), {"text": "wave", "from": 1, "to": 3, "parts": ["left arm"]}], label)
    assert lines[1].parts == {"left arm"}


def test_what_follows_a_text_upon_another_follows_the_whole_body() -> None:
    lines = read_timeline([("walk", 4), {"text": "wave", "from": 1, "to": 3}, ("sit", 2)], label)
    assert (lines[2].start, lines[2].end) == (4, 6)


@given(st.lists(st.floats(0.5, 9.5), min_size=1, max_size=5), st.booleans())
@settings(max_examples=40, deadline=None)
def test_every_part_of_every_frame_is_owned_exactly_once(seconds: list[float], wave: bool) -> None:
    items: list[object] = [("walk", length) for length in seconds]
    if wave and sum(seconds) > 1.5:
        items.append({"text": "wave", "from": 0.5, "to": min(sum(seconds), 2.0)})
    rows = weights(read_timeline(items, label))  # type: ignore[arg-type]
    assert np.sum(rows, axis=0) == pytest.approx(1.0, abs=1e-5)


def test_the_part_of_a_text_upon_another_is_its_own_in_the_middle_of_its_time() -> None:
    walk, wave = weights(read_timeline([("walk", 4), {"text": "wave", "from": 1, "to": 3}], label))
    arm = PARTS.index("right arm")
    assert wave[40, arm] == 1
    assert walk[40, arm] == 0
    assert wave[40].sum() == 1
    assert walk[10].sum() == 6


@pytest.mark.parametrize(
    ("items", "what"),
    [
        ([], "a list of texts"),
        ("walk", "a list of texts"),
        ([("walk", 0.1)], "seconds"),
        ([("walk", 30)], "seconds"),
        ([{"seconds": 3}], "'text' is missing"),
        ([{"text": "walk", "form": 3}], "unknown key form"),
        ([{"text": "walk", "from": 2, "to": 4}], "no text moves the whole body at 0 s"),
        ([{"text": "walk", "from": 2, "to": 1}], "to - from"),
        (
            [("walk", 3), {"text": "wave", "from": 1, "to": 5, "parts": "right arm"}],
            "no text moves the whole body at 3 s",
        ),
        ([("walk", 3), {"text": "x", "from": 1, "to": 2, "parts": "tail"}], "tail"),
        ([3], "line 1"),
    ],
)
def test_timelines_that_cannot_be_are_refused_with_what_is_wrong(items: list[object], what: str) -> None:
    with pytest.raises(InvalidInputError, match=what):
        read_timeline(items, label)  # type: ignore[arg-type]


def test_a_text_of_the_longest_length_may_begin_anywhere() -> None:
    start, end = 6.6, 6.6 + 9.5
    assert end - start > 9.5  # as floats have it
    lines = read_timeline([{"text": "walk", "from": 0, "to": start}, {"text": "sit", "from": start, "to": end}], label)
    assert lines[1].end - lines[1].start == pytest.approx(9.5)
