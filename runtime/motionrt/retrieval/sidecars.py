"""Words beside a library's motions: ``captions.csv`` and ``captions.jsonl`` in the indexed folder or below it.

A row names a clip (``file``, ``path``, ``clip``, ``trial``, ``name`` or ``id``: its path below the sidecar's folder, or
its file name, with or without suffix) and words for it (``captions``, a list, or ``caption``, ``text`` or
``description``); it may name a part (``start_s``, ``end_s``, seconds) and ``tags`` (a list, or one text with commas or
semicolons between them).
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError
from motionrt.retrieval.records import Caption, Skipped
from motionrt.untrusted.files import check_file

SIDECARS = ("captions.csv", "captions.jsonl")
"""What files of words are called."""

_CLIP = ("file", "path", "clip", "trial", "name", "id")
_TEXT = ("captions", "caption", "text", "description")
_MOST = 200_000  # rows of a sidecar


def read_sidecars(
    source: Path, clips: Sequence[str], sidecars: Iterable[str]
) -> tuple[tuple[Caption, ...], list[Skipped]]:
    """Captions of the clips of a folder, in the order of sidecars and rows, and what could not be understood.

    Args:
        source: the indexed folder.
        clips: ids of its clips.
        sidecars: paths of the sidecars below it.
    """
    found: list[Caption] = []
    skipped: list[Skipped] = []
    names: Names | None = None
    for path in sidecars:
        names = names or Names(clips)
        captions, reason = _read(source / path, path.rpartition("/")[0], names)
        found += captions
        if reason:
            skipped.append(Skipped(path, reason))
    return tuple(found), skipped


def _read(path: Path, below: str, names: Names) -> tuple[list[Caption], str | None]:
    found: list[Caption] = []
    try:
        check_file(path, lambda reason, _: FormatError(path, reason))
        for row in _rows(path):
            found += _captions(row, below, names)
    except (OSError, ValueError, RecursionError, csv.Error) as error:
        return found, f"cannot be read: {error}"
    return found, None if found else "none of its rows names a clip of the folder and words for it"


def _rows(path: Path) -> Iterator[Mapping[str, Any]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        lines: Iterable[Any] = csv.DictReader(file) if path.suffix.lower() == ".csv" else _json_lines(file)
        for _, row in zip(range(_MOST), lines, strict=False):
            yield row


def _json_lines(file: Iterable[str]) -> Iterator[Mapping[str, Any]]:
    for line in file:
        if line.strip():
            row = json.loads(line)
            yield row if isinstance(row, dict) else {}


class Names:
    """What a row may call a clip: its path, or its file name, with or without suffix.

    Args:
        clips: ids of the clips.
    """

    def __init__(self, clips: Sequence[str]) -> None:
        self._clips = set(clips)
        self._bare: dict[str, str | None] = {}  # paths without suffix; None is what several clips share
        self._short: dict[str, str | None] = {}  # file names
        for clip in clips:
            folder, _, name = clip.rpartition("/")
            stem = name.rpartition(".")[0] or name
            self._note(self._bare, f"{folder}/{stem}" if folder else stem, clip)
            for short in {name, stem}:
                self._note(self._short, short, clip)

    def find(self, name: str, below: str) -> str | None:
        """The clip that a sidecar in the folder ``below`` calls so; what several clips are called means none."""
        name = name.removeprefix("./")
        for path in (f"{below}/{name}" if below else name, name):
            found = path if path in self._clips else self._bare.get(path)
            if found is not None:
                return found
        return self._short.get(name)

    @staticmethod
    def _note(names: dict[str, str | None], name: str, clip: str) -> None:
        names[name] = clip if name not in names else None


def _captions(row: Mapping[str, Any], below: str, names: Names) -> list[Caption]:
    called = (str(row.get(key) or "").strip().replace("\\", "/") for key in _CLIP)
    clip = next((clip for name in called if name and (clip := names.find(name, below)) is not None), None)
    tags = tuple(_texts(row.get("tags"), split=True))
    texts = [text for key in _TEXT for text in _texts(row.get(key))] or ([""] if tags else [])
    if clip is None:
        return []
    start, end = (_seconds(row.get(f"{key}_s", row.get(key))) for key in ("start", "end"))
    return [Caption(clip, text, start, end, tags) for text in texts]


def _texts(value: object, split: bool = False) -> list[str]:
    parts = (
        value if isinstance(value, list) else re.split(r"[;,]", value) if split and isinstance(value, str) else [value]
    )
    return [part.strip() for part in parts if isinstance(part, str) and part.strip()]


def _seconds(value: object) -> float | None:
    try:
        seconds = float(value) if value not in (None, "") else None  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return seconds if seconds is not None and math.isfinite(seconds) else None
