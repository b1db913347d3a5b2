"""What a reader found of a data set, what it missed, and what it left out and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

SHOWN = 3  # examples of each kind that are printed


@dataclass
class ReadReport:
    """Counts of one reading, filled by the reader and by whoever loads the motions afterwards.

    Attributes:
        corpus: name of the data set.
        layout: which of its published layouts was read.
        rows: annotated motions that the data set names.
        found: clips of every split.
        missing: motion files that the annotations name and the copy at hand lacks, as the annotations name them.
        skipped: reason -> names of what was left out for it.
        notes: what was read otherwise than it is written, such as first cuts; text -> how many rows.
    """

    corpus: str
    layout: str = ""
    rows: int = 0
    found: Counter[str] = field(default_factory=Counter)
    missing: list[str] = field(default_factory=list)
    skipped: dict[str, list[str]] = field(default_factory=dict)
    notes: Counter[str] = field(default_factory=Counter)

    def skip(self, name: str, reason: str) -> None:
        """Leave ``name`` out for ``reason``."""
        self.skipped.setdefault(reason, []).append(name)

    def count(self, splits: Iterable[str]) -> None:
        """Count clips by their splits."""
        self.found.update(splits)

    def as_dict(self) -> dict[str, object]:
        """Plain values, for JSON."""
        return {
            "corpus": self.corpus, "layout": self.layout, "rows": self.rows, "clips": dict(self.found),
            "missing": list(self.missing), "skipped": {reason: list(names) for reason, names in self.skipped.items()},
            "notes": dict(self.notes),
        }  # fmt: skip

    def __str__(self) -> str:
        splits = ", ".join(f"{split} {count}" for split, count in self.found.items()) or "none"
        layout = f" ({self.layout})" if self.layout else ""
        lines = [f"{self.corpus}{layout}: {self.rows} annotated motions, {self.found.total()} clips: {splits}"]
        if self.missing:
            lines.append(f"  missing files: {len(self.missing)}, {_such_as(self.missing)}")
        lines += [f"  left out: {len(names)}, {reason}: {_such_as(names)}" for reason, names in self.skipped.items()]
        lines += [f"  {text}: {count}" for text, count in self.notes.items()]
        return "\n".join(lines)


def _such_as(names: list[str]) -> str:
    more = ", ..." if len(names) > SHOWN else ""
    return f"{', '.join(names[:SHOWN])}{more}"
