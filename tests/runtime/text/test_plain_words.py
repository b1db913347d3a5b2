"""Other people's words are read as the plain ones; what is a word of its own is let alone."""

from __future__ import annotations

import pytest

from motionrt.text import network_text, parse_query
from motionrt.text.spelling import mended
from motionrt.text.wording import worded

SAME = (
    ("takes a knee", "kneels on one knee"),
    ("has a seat", "sits down"),
    ("hang a left", "turns left"),
    ("puts his left hand up", "raises his left hand"),
    ("bolts ahead", "runs ahead"),
    ("gets off the sofa", "stands up from the chair"),
    ("grabs a coin off ground", "picks up a coin from the ground"),
    ("strafes right while facing forward", "strafes right"),
    ("drops to his knees", "kneels down"),
    ("stays put", "stands still"),
    ("bounces the ball", "dribbles a basketball"),
    ("goes up the steps", "climbs up the stairs"),
    ("punts the ball with the right foot", "kicks the ball with the right foot"),
)


@pytest.mark.parametrize(("text", "plain"), SAME)
def test_other_words_say_the_same(text: str, plain: str) -> None:
    assert parse_query(text).said == parse_query(plain).said
    assert parse_query(text).action == parse_query(plain).action


@pytest.mark.parametrize(
    ("slip", "word"),
    [
        ("bakwards", "backwards"),
        ("kcik", "kick"),
        ("rigth", "right"),
        ("jummp", "jump"),
        ("teh", "the"),
        ("persn", "person"),
    ],
)
def test_one_slip_of_the_pen_is_mended(slip: str, word: str) -> None:
    assert mended(slip) == word


@pytest.mark.parametrize(
    "word", ["sand", "singing", "night", "speaking", "arising", "pacing", "watch", "talks", "paints"]
)
def test_words_that_look_like_slips_are_let_alone(word: str) -> None:
    assert mended(word) == word


def test_limbs_and_things_are_not_taken_for_other_acts() -> None:
    assert "pick" not in worded("lifts his left foot off the floor")
    assert "pick" not in worded("gets up off the floor")
    assert worded("puts on boots") == "puts on boots"
    assert parse_query("veering to the right").path == "curve"  # there is a "ring" in it


def test_wording_is_done_once_and_for_all() -> None:
    for text, _ in SAME:
        assert worded(worded(text)) == worded(text)


def test_a_network_reads_plain_texts_as_they_are() -> None:
    assert network_text("A person Walks-forward.") == "A person Walks-forward."
    assert network_text("He chucks a ball") == "he throws a ball"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("stands with both arms out to the sides", "arms_up"),
        ("lifts a can, drinks and lowers it", "arms_up"),
        ("rises onto tiptoe", "travel"),
        ("brings the hands to the face", "path"),
        ("reverses the heading", "travel"),
        ("comes down three steps", "action"),
    ],
)
def test_words_that_only_look_alike_say_nothing(text: str, name: str) -> None:
    assert getattr(parse_query(text), name) in (None, "walk")


def test_the_way_of_a_whole_sentence_keeps_its_adverb() -> None:
    assert parse_query("moves quickly ahead").pace == "fast"
