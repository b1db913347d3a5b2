"""Markdown tables of retrieval rows."""

from __future__ import annotations

from collections.abc import Sequence

from motionrt.metrics import RECALL_AT, Scores
from motionrt_training.evaluate.protocols import ProtocolRow

_HEAD = [*(f"R@{k}" for k in RECALL_AT), "MedR"]

# Petrovich et al. 2023, tables 1 and 2: TMR, full test sets, trained on those data sets with their own texts.
PAPER_ROWS = (
    (
        "HumanML3D, (a) all",
        (5.68, 10.59, 14.04, 20.34, 30.94, 28.00),
        (9.95, 12.44, 17.95, 23.56, 32.69, 28.50),
    ),
    (
        "HumanML3D, (d) batches of 32",
        (67.16, 81.32, 86.81, 91.43, 95.36, 1.04),
        (67.97, 81.20, 86.35, 91.70, 95.27, 1.03),
    ),
    (
        "KIT-ML, (a) all",
        (7.23, 13.98, 20.36, 28.31, 40.12, 17.00),
        (11.20, 13.86, 20.12, 28.07, 38.55, 18.00),
    ),
    (
        "KIT-ML, (d) batches of 32",
        (49.25, 69.75, 78.23, 87.88, 95.00, 1.50),
        (50.12, 67.12, 76.88, 88.88, 94.75, 1.53),
    ),
)


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
    return markdown(head, [[name, *map("{:.2f}".format, t2m + m2t)] for name, t2m, m2t in PAPER_ROWS])


def _cells(scores: Scores) -> list[str]:
    return [*(f"{scores.recall[k]:.1f}" for k in RECALL_AT), f"{scores.median_rank:.1f}"]
