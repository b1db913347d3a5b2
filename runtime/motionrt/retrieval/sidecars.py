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
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from motionrt.errors import FormatError
from motionrt.retrieval.records import Caption, Skipped
from motionrt.untrusted.files import check_file

NAMES = ("captions.csv", "captions.jsonl")
_CLIP = ("file", "path", "clip", "trial", "name", "id")
_TEXT = ("captions", "caption", "text", "description")
_MOST = 200_000  # rows of a sidecar


def read_sidecars(source: Path, clips: Sequence[str]) -> tuple[tuple[Caption, ...], list[Skipped]]:
    """Captions of the clips of a folder, in the order of sidecars and rows, and what could not be understood.

    Args:
        source: the indexed folder.
        clips: ids of its clips.
    """
    found: list[Caption] = []
    skipped: list[Skipped] = []
    for path in sorted(_sidecars(source)):
        captions, reason = _read(path, PurePosixPath(path.parent.relative_to(source).as_posix()), clips)
        found += captions
        if reason:
            skipped.append(Skipped(path.relative_to(source).as_posix(), reason))
    return tuple(found), skipped


def _sidecars(source: Path) -> Iterator[Path]:
    for folder, folders, files in os.walk(source):
        folders[:] = [name for name in folders if not name.startswith(".")]
        yield from (Path(folder) / name for name in files if name.lower() in NAMES)


def _read(path: Path, below: PurePosixPath, clips: Sequence[str]) -> tuple[list[Caption], str | None]:
    known = _by_name(below, clips)
    found: list[Caption] = []
    try:
        check_file(path, lambda reason, _: FormatError(path, reason))
        for row in _rows(path):
            found += _captions(row, known)
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


def _by_name(below: PurePosixPath, clips: Sequence[str]) -> dict[str, str]:
    """What a row may call a clip -> its id; names that several clips share mean none of them."""
    exact = {clip: clip for clip in clips}
    short: dict[str, list[str]] = {}
    for clip in clips:
        path = PurePosixPath(clip)
        inside = path.relative_to(below) if path.is_relative_to(below) else path
        for name in {str(inside), str(inside.with_suffix("")), path.name, path.stem, str(path.with_suffix(""))}:
            short.setdefault(name, []).append(clip)
    return {name: ids[0] for name, ids in short.items() if len(ids) == 1} | exact


def _captions(row: Mapping[str, Any], known: Mapping[str, str]) -> list[Caption]:
    clip = next(
        (known[name] for key in _CLIP if (name := str(row.get(key) or "").strip().replace("\\", "/")) in known), None
    )
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
