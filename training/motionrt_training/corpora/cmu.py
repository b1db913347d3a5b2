"""CMU Graphics Lab trials (BVH and ASF/AMC) with this project's captions.

The folder holds ``bvh/``, ``amc/``, ``asf/`` and ``captions.jsonl``, one JSON object a line: ``id``, ``trial``,
``start_s``, ``end_s``, ``split``, ``labels`` (objects with ``text``) and ``captions``. Splits are fixed by trial in
that file, so no recording is ever on both sides.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport


def read_cmu(folder: str | Path) -> MotionCorpus:
    """The captioned CMU corpus in ``folder``.

    Raises:
        MotionFileNotFoundError: no ``captions.jsonl``, or a trial without its motion file.
        FormatError: a line that is not JSON or misses a key, with its line number.
    """
    captions = Path(folder) / "captions.jsonl"
    if not captions.is_file():
        raise MotionFileNotFoundError(f"{captions} does not exist; point to the folder that holds captions.jsonl")
    clips = tuple(_clip(Path(folder), row, captions, line) for line, row in caption_rows(captions))
    report = ReadReport("cmu", captions.name, len({clip.path for clip in clips}))
    report.count(clip.split for clip in clips)
    return MotionCorpus("cmu", clips, report=report)


def caption_rows(path: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """(line, row) of every row of a ``captions.jsonl``; FormatError for a line that is not JSON."""
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not text.strip():
            continue
        try:
            yield line, json.loads(text)
        except json.JSONDecodeError as error:
            raise FormatError(path, f"not JSON: {error.msg}", line) from None


def _clip(folder: Path, row: dict[str, Any], source: Path, line: int) -> Clip:
    try:
        labels = tuple(label["text"] for label in row["labels"])
        texts = tuple(row["captions"])
        return Clip(row["id"], _trial(folder, row["trial"]), row["start_s"], row["end_s"], texts, row["split"], labels)
    except (KeyError, TypeError) as error:
        raise FormatError(source, f"caption row misses or garbles {error}", line) from None


def _trial(folder: Path, trial: str) -> Path:
    for path in (folder / "bvh" / f"{trial}.bvh", folder / "amc" / f"{trial}.amc"):
        if path.is_file():
            return path
    raise MotionFileNotFoundError(f"trial {trial} has neither {folder}/bvh/{trial}.bvh nor {folder}/amc/{trial}.amc")
