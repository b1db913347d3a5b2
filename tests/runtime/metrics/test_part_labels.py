"""Accuracy of part labels, counted by hand."""

from __future__ import annotations

import pytest

from motionrt.errors import InvalidInputError
from motionrt.metrics import part_accuracy

#          left arm, right arm, left leg, right leg, torso, global
ANSWERS = [
    ("no", "yes", "no", "no", "sometimes", "no"),  # wave the right hand
    ("sometimes", "sometimes", "yes", "yes", "no", "yes"),  # walk
    ("yes", "yes", "no", "no", "no", "no"),  # clap
]


def test_sometimes_counts_for_nothing_and_the_mean_is_over_the_parts() -> None:
    found = part_accuracy([{"right arm", "torso"}, {"left leg", "right leg"}, {"right arm"}], ANSWERS)
    # left arm: 2 answers, 1 right; right arm 2 of 2; legs 3 of 3; torso 2 of 2; global: 2 of 3 (walking misses it)
    assert list(found.accuracy.values()) == pytest.approx([1 / 2, 1, 1, 1, 1, 2 / 3])
    assert list(found.counted.values()) == [2, 2, 3, 3, 2, 3]
    assert found.mean == pytest.approx((0.5 + 4 + 2 / 3) / 6)
    assert (found.phrases, found.exact) == (3, pytest.approx(1 / 3))


def test_a_labeller_that_finds_nothing_is_right_where_the_answer_is_no() -> None:
    found = part_accuracy([(), (), ()], ANSWERS)
    assert list(found.accuracy.values()) == pytest.approx([1 / 2, 0, 2 / 3, 2 / 3, 1, 2 / 3])


def test_parts_may_be_written_with_underscores() -> None:
    same = part_accuracy([["Right_Arm"], ["left_leg"], []], ANSWERS)
    assert same == part_accuracy([["right arm"], ["left leg"], []], ANSWERS)


@pytest.mark.parametrize(
    ("found", "answers", "message"),
    [
        ([()], ANSWERS, "1 phrases were labelled"),
        ([("tail",), (), ()], ANSWERS, "unknown body part"),
        ([()], [("yes", "no")], "needs 6 answers"),
        ([()], [("maybe",) * 6], "out of yes, no, sometimes"),
        ([()], [("sometimes", *["no"] * 5)], "left arm"),
        ([], [], "at least one phrase"),
    ],
)
def test_rows_that_do_not_fit_are_refused(found, answers, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        part_accuracy(found, answers)
