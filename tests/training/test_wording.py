"""Sentences made for training: forms of actions, what was measured, the grammar, captions of joined clips."""

from __future__ import annotations

import numpy as np
import pytest
from motions import standing, walking

pytest.importorskip("lemminflect", reason="wording needs lemminflect (extra 'train')")

from motionrt.motion.attributes import measure
from motionrt_training.corpora.joining import joined_clips
from motionrt_training.corpora.text_mirror import mirror_text, side_words
from motionrt_training.wording.grammar import sentences
from motionrt_training.wording.measured import say_measured
from motionrt_training.wording.saying import gerund, third_person


@pytest.mark.parametrize(
    ("order", "third", "ing"),
    [
        ("walk forward", "walks forward", "walking forward"),
        ("sit down", "sits down", "sitting down"),
        ("lie on the back", "lies on the back", "lying on the back"),
        ("run in place", "runs in place", "running in place"),
        ("catch the ball", "catches the ball", "catching the ball"),
    ],
)
def test_actions_take_the_forms_of_captions(order: str, third: str, ing: str) -> None:
    assert (third_person(order), gerund(order)) == (third, ing)


@pytest.mark.parametrize(("turn", "side"), [(0.6, "left"), (-0.6, "right")])
def test_a_walk_that_turns_is_told_with_its_side(turn: float, side: str) -> None:
    said = say_measured(measure(walking(80, turn=turn)), np.random.default_rng(0), 40)
    sides = {word for text in said for word in side_words(text)}
    sense = "counterclockwise" if side == "left" else "clockwise"
    assert sides
    assert sides <= {side, sense, f"{side}wards"}


def test_somebody_who_stands_is_not_said_to_walk_or_turn() -> None:
    said = say_measured(measure(standing(60)), np.random.default_rng(0), 20)
    assert said
    assert not any(word in text for text in said for word in ("walk", "turn", "run", "step"))


def test_the_grammar_gives_different_sentences_and_the_same_ones_again() -> None:
    first, again = (sentences(300, np.random.default_rng(4)) for _ in range(2))
    assert first == again
    assert len(set(first)) == 300
    assert not any("{" in text for text in first)
    assert {"left", "right"} <= {word for text in first for word in side_words(text)}


def test_a_joined_clip_says_both_parts_in_order_and_holds_both() -> None:
    rows = [
        (np.full((150, 263), value, np.float16), {"texts": [text]}) for value, text in ((1, "jump"), (2, "turn left"))
    ]
    (features, meta), *_ = joined_clips(rows, 1, np.random.default_rng(0))
    words = ("jump", "turn left") if features[0, 0] == 1 else ("turn left", "jump")
    assert len(features) == 200
    assert set(features[:100, 0]) != set(features[100:, 0])
    assert all(text.startswith(words[0]) and text.endswith(words[1]) for text in meta["texts"])
    assert meta["texts_mirror"] == [mirror_text(text) for text in meta["texts"]]


@pytest.mark.parametrize(
    "text", ["he starts right away", "stands upright", "jumps, right after that he stops", "left the room"]
)
def test_words_that_name_no_side_are_left_alone(text: str) -> None:
    assert side_words(text) == []
    assert mirror_text(text) == text


@pytest.mark.parametrize("text", ["turns right before he stops", "swings left at the end", "right hand up"])
def test_a_side_before_a_time_or_a_place_is_a_side(text: str) -> None:
    assert len(side_words(text)) == 1
    assert mirror_text(mirror_text(text)) == text


def test_the_sides_of_a_sentence_are_counted() -> None:
    assert side_words("Turns left, then clockwise with the right hand") == ["left", "clockwise", "right"]
