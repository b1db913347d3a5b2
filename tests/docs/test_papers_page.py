"""docs/papers.md holds the papers' figures as their file has them, and the options that it names exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytest.importorskip("torch", reason="torch is not installed: pip install 'motionrt[train]'")

import make_papers

from motionrt_training.recipes import temos, tmr, walknet


def test_the_page_is_made_from_the_file_of_figures() -> None:
    page = make_papers.PAGE.read_text(encoding="utf-8")
    assert make_papers.made(page) == page, "run: python docs/make_papers.py"
    assert "| TMR | Table 2 | KIT-ML, (d) batches of 32, text to motion | 49.25 | 69.75 | 78.25 |" in page


@pytest.mark.parametrize(("name", "recipe"), [("tmr", tmr), ("temos", temos), ("walknet", walknet)])
def test_command_lines_of_the_pages_are_understood(name: str, recipe) -> None:
    texts = [(make_papers.PAGE.with_name(page)).read_text(encoding="utf-8") for page in ("papers.md", "train.md")]
    lines = [line for text in texts for line in re.findall(rf"`{name} (--[^`]*)`", text.replace("\n", " "))]
    assert lines
    for line in lines:
        needed = ["--corpus", "a.npz", "--out", str(Path("runs"))]
        needed += ["--captions-file", "a.jsonl"] if name == "temos" else []
        words = [word for word in line.split() if word != "…"]
        try:
            recipe.parser().parse_args([*needed, *words])
        except SystemExit:
            pytest.fail(f"{name} {line}")
