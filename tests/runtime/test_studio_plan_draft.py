"""Plans in the making: times without gaps, texts upon texts, and files that say the same."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.studio.plan_draft import LONGEST_S, MOVES, SHORTEST_S, WHOLE, PlanDraft
from motionrt.synthesis.constraints import Target, Waypoint
from motionrt.synthesis.plan import Plan
from motionrt.synthesis.timeline import read_timeline

spans = st.tuples(st.integers(0, 5), st.floats(0, 30), st.floats(0, 30))


def drafted(*texts: str) -> PlanDraft:
    draft = PlanDraft()
    for text in texts:
        draft = draft.with_text(text)
    return draft


def whole(draft: PlanDraft) -> list[tuple[float, float]]:
    return sorted((line.start, line.end) for line in draft.lines if line.moves == WHOLE)


def test_texts_follow_each_other_and_parts_lie_upon_them() -> None:
    draft = drafted("walk", "sit down").with_text("wave", "right arm")
    assert whole(draft) == [(0.0, 2.0), (2.0, 4.0)]
    assert (draft.lines[2].start, draft.lines[2].end) == (0.0, 4.0)


@given(st.lists(spans, max_size=8))
def test_whatever_is_dragged_the_runtime_takes_the_timeline(moves: list[tuple[int, float, float]]) -> None:
    draft = drafted("walk", "turn left", "sit down").with_text("wave", "right arm")
    for index, start, end in moves:
        draft = draft.with_span(index % 4, start, end)
    rows = whole(draft)
    assert rows[0][0] == 0
    assert all(a[1] == pytest.approx(b[0], abs=1e-6) for a, b in pairwise(rows))
    assert all(SHORTEST_S - 1e-6 <= end - start <= LONGEST_S + 1e-6 for start, end in rows)
    lines = read_timeline(draft.timeline(), lambda _: frozenset({"right arm"}))
    assert len(lines) == 4


def test_a_text_that_is_taken_away_leaves_no_gap_and_the_last_one_nothing() -> None:
    draft = drafted("walk", "turn left", "sit down").without("lines", 1)
    assert whole(draft) == [(0.0, 2.0), (2.0, 4.0)]
    assert drafted("walk").without("lines", 0) == PlanDraft()


def test_a_plan_as_a_file_says_the_same(tmp_path: Path) -> None:
    draft = drafted('walk: forward, "fast"', "sit down").with_text("wave", "right arm").with_text("nod", "torso")
    path, targets = (
        (Waypoint(1.0, (0.5, 1.5)), Waypoint(2.0, (1.0, 2.0), 30.0)),
        (Target(1.5, "left_wrist", (0.1, 1, 2)),),
    )
    draft = PlanDraft(draft.lines, path, targets)
    file = tmp_path / "plan.yaml"
    file.write_text(draft.text(), encoding="utf-8")
    back = PlanDraft.of(Plan.read(file))
    assert back.timeline() == draft.timeline()
    assert (back.path, back.targets) == (path, targets)


@pytest.mark.parametrize("moves", list(MOVES))
def test_every_choice_of_parts_survives_the_file(moves: str, tmp_path: Path) -> None:
    draft = drafted("walk").with_text("wave", moves)
    (tmp_path / "plan.yaml").write_text(draft.text(), encoding="utf-8")
    assert [line.moves for line in PlanDraft.of(Plan.read(tmp_path / "plan.yaml")).lines] == [WHOLE, moves]


def test_an_empty_text_is_refused_and_html_is_escaped() -> None:
    with pytest.raises(InvalidInputError, match="write what somebody does"):
        PlanDraft().with_text("  ")
    assert "<b>" not in drafted("<b>walk").picture()
