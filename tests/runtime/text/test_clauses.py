"""Texts are taken apart where acts follow one another, and nowhere else."""

from __future__ import annotations

import pytest

from motionrt.text import clauses

FOLLOW = (
    ("walks forward then sits down", ("walks forward", "sits down")),
    ("stand up and walk away", ("stand up", "walk away")),
    ("sits down, waves, then gets up", ("sits down", "waves while sitting", "gets up")),
    ("before kicking the ball he steps back", ("steps back", "kicking the ball")),
    ("waves after turning around", ("turning around", "waves")),
    ("turns around and walks back", ("turns around", "walks forward")),
    ("lies down and then stands up", ("lies down", "stands up from the floor")),
    ("kneels, then walks on", ("kneels", "stands up and walks on")),
    ("punches with the left and then with the right", ("punches with the left", "punches with the right")),
    ("He walks. He jumps.", ("walks", "jumps")),
    ("picks up a box and carries it forward", ("picks up a box", "carries it forward")),
)
AT_ONCE = (
    "a person walks forward and turns left",
    "walks while waving",
    "bends down and picks something up from the floor",
    "gets down on hands and knees and crawls forward",
    "walks slowly, looking around",
    "jumps up and down",
    "a person walks forward and waves with both hands",
    "",
)


@pytest.mark.parametrize(("text", "acts"), FOLLOW)
def test_acts_that_follow_one_another_are_told_apart(text: str, acts: tuple[str, ...]) -> None:
    assert clauses(text) == acts


@pytest.mark.parametrize("text", AT_ONCE)
def test_acts_at_once_stay_one_text(text: str) -> None:
    assert clauses(text) == (text,)
