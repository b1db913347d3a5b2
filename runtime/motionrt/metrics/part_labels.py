"""Accuracy of body-part labels against answers of people: yes, no, or sometimes  [SINC 3.1, Table 1]."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import PARTS, checked_parts

ANSWERS = ("yes", "no", "sometimes")


@dataclass(frozen=True)
class PartAccuracy:
    """How often a labeller says what people say; 'sometimes' counts for nothing.

    Attributes:
        accuracy: share, 0 to 1, of right answers for every part of :data:`motionrt.motion.body_parts.PARTS`.
        counted: how many answers of yes or no each part has.
        mean: mean over the parts.
        phrases: how many phrases were labelled.
        exact: share of phrases without any wrong answer.
    """

    accuracy: dict[str, float]
    counted: dict[str, int]
    mean: float
    phrases: int
    exact: float

    def as_dict(self) -> dict[str, object]:
        """Plain values by name, for JSON."""
        return asdict(self)


def part_accuracy(found: Sequence[Iterable[str]], answers: Sequence[Sequence[str]]) -> PartAccuracy:
    """Compare the parts that were found for every phrase with its answers.

    Args:
        found: for every phrase, names of parts.
        answers: for every phrase, one of yes, no and sometimes for each part, in the order of ``PARTS``.

    Raises:
        InvalidInputError: not as many rows, an unknown part or answer, or a part that is 'sometimes' everywhere.
    """
    truth = _checked(answers)
    if len(found) != len(truth):
        raise InvalidInputError(f"{len(found)} phrases were labelled, but there are answers for {len(truth)}")
    said = np.array([[part in names for part in PARTS] for names in map(checked_parts, found)])
    counts = truth != "sometimes"
    if not counts.any(axis=0).all():
        unsure = [part for part, known in zip(PARTS, counts.any(axis=0), strict=True) if not known]
        raise InvalidInputError(f"no phrase has a yes or no for: {', '.join(unsure)}")
    right = said == (truth == "yes")
    shares = (right & counts).sum(axis=0) / counts.sum(axis=0)
    return PartAccuracy(
        dict(zip(PARTS, map(float, shares), strict=True)),
        dict(zip(PARTS, map(int, counts.sum(axis=0)), strict=True)),
        float(shares.mean()),
        len(truth),
        float((right | ~counts).all(axis=1).mean()),
    )


def _checked(answers: Sequence[Sequence[str]]) -> npt.NDArray[np.str_]:
    rows = [[str(answer).strip().lower() for answer in row] for row in answers]
    for number, row in enumerate(rows, 1):
        if len(row) != len(PARTS) or not set(row) <= set(ANSWERS):
            raise InvalidInputError(f"row {number} needs {len(PARTS)} answers out of {', '.join(ANSWERS)}, not {row}")
    if not rows:
        raise InvalidInputError("give the answers for at least one phrase")
    return np.array(rows)
