"""Gestures that a text means: whose hands, and what is none."""

from __future__ import annotations

import pytest

from motionrt.text import gestures_of_text, parse_query


def hands(text: str) -> dict[str, str]:
    return {side: gesture.about for side, gesture in gestures_of_text(parse_query(text)).hands}


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        ("a person claps", {"left", "right"}),
        ("points at the door with the left hand", {"left"}),
        ("points at the door", {"right"}),
        ("someone drinks with the right hand", {"right"}),
        ("raises both arms", {"left", "right"}),
        ("raises the left hand", {"left"}),
        ("a man plays the guitar", {"left", "right"}),
        ("walks forward", set()),
        ("does not clap", set()),
        ("point of view", set()),
        ("does a cartwheel", set()),
    ],
)
def test_the_hands_that_a_text_means_are_found(text: str, sides: set[str]) -> None:
    assert set(hands(text)) == sides


def test_places_at_the_head_are_told_from_places_before_the_chest() -> None:
    assert set(hands("drinks a cup of tea").values()) == {"head"}
    assert set(hands("claps").values()) == {"shoulder"}


def test_trunks_knees_and_feet_are_found() -> None:
    def found(text: str):  # type: ignore[no-untyped-def]
        return gestures_of_text(parse_query(text))

    assert found("takes a bow").bows
    assert not found("shoots with bow and arrow").bows
    assert found("a soldier marches in place").marches
    assert found("balances on the left leg").lifted == "right"
    assert found("kneels on the right knee").kneels == "right"
    assert found("kneels down").kneels == "both"
    assert found("scratches a knee").kneels is None
