"""Sentences and what is meant by them."""

from __future__ import annotations

import pytest

from motionrt.errors import InvalidInputError
from motionrt.locomotion.words import Instruction, parse_instruction
from motionrt.locomotion.words.vocabulary import find_label, singular


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("sit on the sofa", Instruction("sit", "sofa")),
        ("Sit down on the couch!", Instruction("sit", "couch")),
        ("please take a seat on the office chair.", Instruction("sit", "office chair")),
        ("grab from the shelf at 1.2 m", Instruction("grab", "shelf", 1.2)),
        ("grab from the shelf at 120 cm", Instruction("grab", "shelf", 1.2)),
        ("grab from the shelf at a height of 0,8 metres", Instruction("grab", "shelf", 0.8)),
        ("at 60cm", None),
        ("take the cup from the table", Instruction("grab", "table", item="cup")),
        (
            "pick up the book off the shelf at 1.5m with the left hand",
            Instruction("grab", "shelf", 1.5, "left", "book"),
        ),
        ("pick the book up", Instruction("grab", "book")),
        ("reach the lamp", Instruction("reach", "lamp")),
        ("reach for the lamp", Instruction("reach", "lamp")),
        ("reach out to the lamp using your right hand", Instruction("reach", "lamp", hand="right")),
        ("stand at the window", Instruction("stand", "window")),
        ("stand in front of the window", Instruction("stand", "window")),
        ("walk over to the window", Instruction("stand", "window")),
        ("go to the door", Instruction("stand", "door")),
        ("touch the wall with the left hand", Instruction("touch", "wall", hand="left")),
        ("then press the light_switch at 1 m", Instruction("touch", "light switch", 1.0)),
        ("turn on the lamp", Instruction("touch", "lamp")),
    ],
)
def test_sentences_are_understood(text: str, meaning: Instruction | None) -> None:
    if meaning is None:
        with pytest.raises(InvalidInputError):
            parse_instruction(text)
    else:
        assert parse_instruction(text) == meaning


def test_an_unknown_verb_is_refused_with_the_verbs_there_are() -> None:
    with pytest.raises(InvalidInputError, match=r"no known verb in 'dance with the lamp'.*grab.*reach.*sit.*touch"):
        parse_instruction("dance with the lamp")


def test_an_instruction_without_object_is_refused_with_an_example() -> None:
    with pytest.raises(InvalidInputError, match=r"'sit down' names no object; .* 'sit on the sofa'"):
        parse_instruction("sit down")


def test_a_height_in_the_wrong_unit_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="a height of 120 m in"):
        parse_instruction("grab from the shelf at 120 m")


@pytest.mark.parametrize("text", ["", "   ", "?!"])
def test_nothing_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="no known verb"):
        parse_instruction(text)


@pytest.mark.parametrize(
    ("name", "labels", "found"),
    [
        ("sofa", ("chair", "sofa"), "sofa"),
        ("couch", ("chair", "sofa"), "sofa"),
        ("red leather sofa", ("chair", "couch"), "couch"),
        ("coffee table", ("table", "coffee_table"), "coffee_table"),
        ("shelves", ("Book-Shelf", "shelf"), "shelf"),
        ("bookcase", ("shelves",), "shelves"),
        ("chair", ("chairs",), "chairs"),
        ("couch", ("couch", "sofa"), "couch"),
        ("throne", ("chair", "sofa"), None),
    ],
)
def test_a_name_finds_its_label(name: str, labels: tuple[str, ...], found: str | None) -> None:
    assert find_label(name, labels) == found


@pytest.mark.parametrize(
    ("word", "one"),
    [
        ("shelves", "shelf"),
        ("couches", "couch"),
        ("boxes", "box"),
        ("lamps", "lamp"),
        ("glass", "glass"),
        ("bus", "bus"),
    ],
)
def test_plurals(word: str, one: str) -> None:
    assert singular(word) == one
