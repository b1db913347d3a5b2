"""Markdown tables of retrieval rows."""

from __future__ import annotations

from collections.abc import Sequence

from motionrt.metrics import RECALL_AT, Scores
from motionrt_training.evaluate.protocols import ProtocolRow
from motionrt_training.evaluate.published import retrieval_figures

_HEAD = [*(f"R@{k}" for k in RECALL_AT), "MedR"]


def markdown(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def retrieval_table(rows: Sequence[tuple[str, ProtocolRow]]) -> str:
    """One line for each (name, row): recalls and median rank, text to motion and motion to text."""
    head = ["", "pairs", *(f"{name} t2m" for name in _HEAD), *(f"{name} m2t" for name in _HEAD)]
    body = [[name, row.pairs, *_cells(row.text_to_motion), *_cells(row.motion_to_text)] for name, row in rows]
    return markdown(head, body)


def paper_table() -> str:
    """TMR's own figures, for orientation."""
    head = ["TMR as published", *(f"{name} t2m" for name in _HEAD), *(f"{name} m2t" for name in _HEAD)]
    return markdown(head, [[row.row, *map("{:.2f}".format, row.t2m + row.m2t)] for row in retrieval_figures()])


def _cells(scores: Scores) -> list[str]:
    return [*(f"{scores.recall[k]:.1f}" for k in RECALL_AT), f"{scores.median_rank:.1f}"]
