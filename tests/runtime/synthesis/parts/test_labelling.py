"""One call for the parts of a text, whoever labels it."""

from __future__ import annotations

import pytest

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.parts import body_parts


def test_rules_are_the_default() -> None:
    assert body_parts("wave the left hand") == {"left arm"} == body_parts("wave the left hand", labeller="rules")


def test_a_language_model_is_the_callers() -> None:
    assert body_parts("wave", labeller="llm", complete=lambda prompt: "Right arm.") == {"right arm"}
    with pytest.raises(InvalidInputError, match="needs a language model"):
        body_parts("wave", labeller="llm")


def test_a_callable_may_spell_parts_its_own_way() -> None:
    assert body_parts("x", labeller=lambda text: ["Left_Arm", "torso"]) == {"left arm", "torso"}  # type: ignore[arg-type,return-value]


@pytest.mark.parametrize("answer", [{"tail"}, None, 3])
def test_a_callable_that_returns_no_parts_is_an_error(answer: object) -> None:
    with pytest.raises(InvalidInputError, match="body part"):
        body_parts("walk", labeller=lambda text: answer)  # type: ignore[arg-type,return-value]


@pytest.mark.parametrize("labeller", ["rules", "llm", lambda text: frozenset({"torso"})])
@pytest.mark.parametrize("text", ["", " \t", None])
def test_empty_text_is_an_error_for_all(text: object, labeller: object) -> None:
    with pytest.raises(InvalidInputError, match="empty"):
        body_parts(text, labeller=labeller)  # type: ignore[arg-type]


def test_an_unknown_labeller_is_an_error_that_lists_them() -> None:
    with pytest.raises(InvalidInputError, match="'rules' and 'llm'"):
        body_parts("walk", labeller="magic")


def test_what_a_callable_raises_comes_out_as_it_is() -> None:
    with pytest.raises(ZeroDivisionError):
        body_parts("walk", labeller=lambda text: frozenset({str(1 // 0)}))


def test_a_language_model_that_nobody_asks_is_an_error() -> None:
    with pytest.raises(InvalidInputError, match="labeller='llm'"):
        body_parts("walk", complete=lambda prompt: "torso")


@pytest.mark.parametrize("text", ["a" * 1_000_000, "wave " * 100_000, "!!!", "\x00", "挥手 👋"])
def test_any_text_is_read(text: str) -> None:
    assert body_parts(text) <= set(PARTS)
