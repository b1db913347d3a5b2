"""The papers' own figures: one file, read by reports and by the page on the papers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import yaml

FILE = Path(__file__).with_name("published.yaml")


@dataclass(frozen=True)
class Figure:
    """One figure: the paper, the section or table that it stands in, what it is."""

    paper: str
    place: str
    what: str
    value: float


@dataclass(frozen=True)
class RetrievalFigures:
    """One row of a table of retrieval: R@1, 2, 3, 5, 10 and the median rank, in both directions."""

    paper: str
    table: str
    row: str
    t2m: tuple[float, ...]
    m2t: tuple[float, ...]


def papers() -> dict[str, str]:
    """Short name -> authors, title, where."""
    return dict(_content()["papers"])


def figures() -> tuple[Figure, ...]:
    """Every single figure, in the order of the file."""
    return tuple(Figure(**row) for row in _content()["figures"])


def retrieval_figures() -> tuple[RetrievalFigures, ...]:
    """Every row of a table of retrieval."""
    return tuple(
        RetrievalFigures(row["paper"], row["table"], row["row"], tuple(row["t2m"]), tuple(row["m2t"]))
        for row in _content()["retrieval"]
    )


@lru_cache(maxsize=1)
def _content() -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(FILE.read_text(encoding="utf-8"))
    return found
