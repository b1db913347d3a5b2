"""What the rules make of action text: cases worked by hand, and any text at all."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motionrt.errors import FormatError, InvalidInputError
from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.parts import RulesLabeller
from motionrt.synthesis.parts.lexicon import load_lexicon

LABEL = RulesLabeller()
CODES = {
    "la": ["left arm"],
    "ra": ["right arm"],
    "ll": ["left leg"],
    "rl": ["right leg"],
    "t": ["torso"],
    "g": ["global"],
}
CODES |= {"A": list(ARMS), "L": list(LEGS), "W": list(PARTS), "-": []}
PHRASES = Path(__file__).with_name("development_phrases.tsv")


def parts(codes: str) -> frozenset[str]:
    return frozenset(part for code in codes.split() for part in CODES[code])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("walk", "L g"),
        ("raise hand", "ra"),
        ("sit", "L g"),
        ("clap", "A"),
        ("kick with the right leg", "rl"),
        ("rotate shoulders", "A"),
        ("put headphones over ears", "A"),
        ("look left", "t"),
        ("walk backwards with arms attached to the waist", "A L g"),
    ],
)
def test_phrases_whose_parts_are_ambiguous_come_out_as_documented(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("carry the crate to the van", "A L g"),
        ("he carries a plank away", "A L g"),
        ("push the crate across the yard", "A L g"),
        ("roll the barrel up the ramp", "A L g"),
        ("dribble forward", "A L g"),
        ("carry a crate", "A"),
        ("push the crate open", "A"),
        ("push up the sleeves", "A"),
        ("bring the cup to the mouth", "A"),
        ("push a cup across the table", "A"),
        ("take the cup from the table", "A"),
    ],
)
def test_who_moves_a_thing_along_a_way_walks_and_who_moves_it_in_place_does_not(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("take off the left shoe", "A ll t"),
        ("kick off the left boot", "ll"),
        ("kick the legs in the water", "L"),
        ("kick the legs of the opponent", "rl"),
        ("with the left foot, she draws a line", "ll"),
        ("drop to one knee", "L g"),
        ("lower themselves onto both knees", "L g"),
        ("pick a leaf up with the left hand", "la t"),
        ("pick up the phone", "A"),
    ],
)
def test_legs_and_trunk_move_where_the_words_imply_it(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("stand with the arms hanging down", "L"),
        ("stand with the arms relaxed", "L"),
        ("walk with the left arm tied", "L g"),
        ("hang from a bar with the arms", "A"),
        ("stand on the left leg and stretch both arms", "A L"),
        ("stand and stretch both arms", "A"),
        ("dance on the spot", "A L t"),
        ("jump on the spot", "L g"),
    ],
)
def test_idle_arms_rest_a_standing_leg_works_and_steps_on_the_spot_lead_nowhere(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("wave the left hand", "la"),
        ("wave with both hands", "A"),
        ("wave", "A"),
        ("throw a ball with his left", "la"),
        ("left-handed throw", "la"),
        ("a left jab", "la"),
        ("jab left and right", "A"),
        ("kick with right then left", "L"),
        ("left front kick", "ll"),
        ("kick with each leg", "L"),
        ("lift the knees alternately", "L"),
        ("left and right hands up", "A"),
        ("raise left leg and arm", "ll la"),
        ("use the left foot to kick", "ll"),
        ("tap the left foot", "ll"),
        ("touch right knee with left hand", "la"),
        ("touch the left elbow", "ra"),
        ("touch left elbow to right knee", "la rl t"),
        ("draw a circle with the left foot", "ll"),
        ("eat with a spoon in the left hand", "la"),
        ("wave with his left hand over his head", "la"),
        ("hold left foot with right hand", "ll ra"),
    ],
)
def test_sides_go_to_the_limb_that_acts(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("walk while waving the left hand", "L g la"),
        ("raise and lower the left arm", "la"),
        ("raise the right hand, then lower it", "ra"),
        ("raise the left arm and the right leg", "la rl"),
        ("wave the right hand then kick with the left leg", "ra ll"),
        ("arms swinging, head nodding", "A t"),
        ("step forward with the left foot and throw a right punch", "L g ra"),
        ("sit down and look around", "L g t"),
        ("drink with the left hand while walking backwards", "la L g"),
    ],
)
def test_clauses_add_up(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("walk without moving the arms", "L g"),
        ("walk with the arms still", "L g"),
        ("keeping the torso still, swing both arms", "A"),
        ("rotate the head keeping the shoulders still", "t"),
        ("run, not moving the left arm", "ra L g"),
        ("neither arm moves while he walks", "L g"),
        ("walk without bending the knees", "L g"),
        ("don't move the legs, only wave", "A"),
        ("stand still", "L"),
        ("stand still and look around", "t"),
        ("stand with legs still", "L"),
        ("standing with arms folded", "A"),
        ("hands in pockets", "A"),
        ("jog in place", "L"),
        ("walk on the spot", "L"),
    ],
)
def test_denial_rest_and_posture(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("turn left", "L g t"),
        ("turn the head left", "t"),
        ("turn the page", "A"),
        ("turn the steering wheel", "A"),
        ("bend forward", "t"),
        ("bend the knees", "L"),
        ("twist", "t"),
        ("twist the cap", "A"),
        ("move forward", "L g"),
        ("move the box", "A"),
        ("move the hips", "t g"),
        ("roll", "W"),
        ("roll the left shoulder", "la"),
        ("pick up a cup", "A"),
        ("pick up a box", "A t"),
        ("pick up a pen from the floor", "A t"),
        ("lift a box", "A"),
        ("step back", "L g"),
        ("arch the back", "t"),
        ("head to the door", "L g"),
    ],
)
def test_the_object_decides_what_a_verb_moves(text: str, expected: str) -> None:
    assert LABEL(text) == parts(expected)


@pytest.mark.parametrize(
    "text", ["waves", "waving", "waved", "WAVE!", "a person waves", "does a wave", "wvae", "  wave\n"]
)
def test_inflection_case_subjects_and_exchanged_letters_do_not_matter(text: str) -> None:
    assert LABEL(text) == {"left arm", "right arm"}


def test_a_slip_is_mended_only_where_nothing_else_is_known() -> None:
    assert LABEL("jumpping") == parts("L g")
    assert LABEL("clap on a stool") == parts("A")  # "stool" is no "stood"


def test_unknown_actions_take_both_hands_with_an_object_and_the_whole_body_without() -> None:
    assert LABEL("zorble the gwimbit") == parts("A")
    assert LABEL("zorble") == parts("W")


def test_an_encoder_finds_the_nearest_phrase_for_unknown_words() -> None:
    def encode(text: str) -> np.ndarray:
        return np.array([1.0, 0.0] if text in ("zorble", "kneel") else [0.0, 1.0], np.float32)

    label = RulesLabeller(encoder=encode)
    assert label("zorble") == parts("L g")
    assert "'kneel'" in label.explain("zorble")[-1].rule
    assert label("wave") == parts("A"), "known words need no encoder"


def test_explain_names_words_and_rules_that_add_up_to_the_answer() -> None:
    reasons = LABEL.explain("walk without moving the arms while wiping the table with the left hand")
    gives = [(reason.words, reason.parts) for reason in reasons if reason.adds]
    assert gives[0] == ("walk", parts("L g"))
    assert "left hand" in gives[1][0]
    taken = [reason for reason in reasons if not reason.adds]
    assert [(reason.words, reason.parts) for reason in taken] == [("the arms", parts("A"))]


@pytest.mark.parametrize("text", ["", "  \n", None, 7])
def test_empty_text_is_an_error(text: object) -> None:
    with pytest.raises(InvalidInputError, match="say what somebody does"):
        LABEL(text)  # type: ignore[arg-type]


USUAL = (
    "walk wave the left right hand hands and with then both of raise knee touch not without still , back up other "
    "keeping arms a box turn head to in place kick step one use"
)
WORDS = st.sampled_from(USUAL.split())


@given(st.text(min_size=1).filter(str.strip) | st.lists(WORDS, min_size=1, max_size=12).map(" ".join))
@settings(max_examples=100, deadline=None)
def test_any_text_gives_a_set_of_parts(text: str) -> None:
    assert LABEL(text) <= set(PARTS)
    assert LABEL(text) == LABEL(text.upper()) or not text.isascii()


MIRRORED = [
    "wave the left hand",
    "kick with the right leg",
    "touch right knee with left hand",
    "raise left leg and arm",
]


@pytest.mark.parametrize("text", MIRRORED)
def test_exchanging_the_sides_of_the_text_exchanges_the_sides_of_the_parts(text: str) -> None:
    def exchanged(words: str) -> str:
        return words.replace("left", "#").replace("right", "left").replace("#", "right")

    assert LABEL(exchanged(text)) == {exchanged(part) for part in LABEL(text)}


def test_the_development_phrases_are_labelled_nearly_all() -> None:
    rows = [line.split("\t") for line in PHRASES.read_text("utf-8").splitlines() if not line.startswith("#")]
    right = dict.fromkeys(PARTS, 0)
    judged = dict.fromkeys(PARTS, 0)
    for text, yes, maybe in rows:
        found = LABEL(text)
        for part in set(PARTS) - (parts(maybe) - parts(yes)):
            judged[part] += 1
            right[part] += (part in found) == (part in parts(yes))
    assert len(rows) >= 300
    assert np.mean([right[part] / judged[part] for part in PARTS]) >= 0.97


def test_every_phrase_of_the_lexicon_is_found_by_its_own_words() -> None:
    for entry in load_lexicon().entries:
        assert LABEL(" ".join(entry.phrase)) <= set(PARTS)


def test_a_broken_lexicon_line_is_named(tmp_path: Path) -> None:
    path = tmp_path / "words.tsv"
    path.write_text("# words\nGL\tgait\twalk\nX\tgait\trun\n", encoding="utf-8")
    with pytest.raises(FormatError, match=r"words\.tsv:3"):
        load_lexicon(path)
