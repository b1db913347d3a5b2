"""Captions of stretches of sequences: grouped to clips, and the annotation files that unify several data sets.

``annotations.json`` holds ``{id: {"path", "duration", "annotations": [{"text", "start", "end"}]}}``, the same for
KIT-ML, HumanML3D and BABEL; its splits lie beside it or in ``splits/``.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError
from motionrt_training.corpora.amass import amass_file, read_json, read_splits, require_some, sequence_name
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

Captioned = tuple[str, float, float | None]  # a text, and its first and last second

MIRRORED = "a mirrored copy; training mirrors by itself"
NO_SPLIT = "in none of train.txt, val.txt, test.txt"
NO_TEXT = "has no caption"


def clips_of(name: str, path: Path, captions: Iterable[Captioned], split: str) -> list[Clip]:
    """One clip for every stretch that captions speak of: ``name``, then ``name_1`` and so on."""
    grouped: dict[tuple[float, float | None], list[str]] = {}
    for text, start, end in captions:
        grouped.setdefault((start, end), []).append(text)
    return [
        Clip(name if index == 0 else f"{name}_{index}", path, begin, stop, tuple(texts), split)
        for index, ((begin, stop), texts) in enumerate(grouped.items())
    ]


def read_annotations(name: str, folder: Path, amass: Path) -> MotionCorpus:
    """The corpus of an ``annotations.json``; stretches of several captions become clips of their own."""
    report, splits = ReadReport(name, "annotations.json"), read_splits(folder)
    clips: list[Clip] = []
    for key, entry in read_json(folder / "annotations.json").items():
        report.rows += 1
        clips += _entry(key, entry, folder / "annotations.json", amass, splits, report)
    report.count(clip.split for clip in clips)
    require_some(report, amass)
    return MotionCorpus(name, tuple(clips), report=report)


def _entry(
    key: str, entry: dict[str, Any], source: Path, amass: Path, splits: dict[str, str], report: ReadReport
) -> list[Clip]:
    try:
        sequence = str(entry["path"])
        captions = [_captioned(row) for row in entry["annotations"]]
    except (KeyError, TypeError, ValueError) as error:
        raise FormatError(source, f"entry '{key}' misses or garbles {error}") from None
    captions = [(text, start, end) for text, start, end in captions if text and (end is None or end > start)]
    path = amass_file(amass, sequence)
    if key not in splits or key.startswith("M"):
        report.skip(key, MIRRORED if key.startswith("M") else NO_SPLIT)
    elif not captions:
        report.skip(key, NO_TEXT)
    elif path is None:
        report.missing.append(sequence_name(sequence))
    else:
        return clips_of(key, path, captions, splits[key])
    return []


def _captioned(row: dict[str, Any]) -> Captioned:
    return str(row["text"]).strip(), float(row["start"]), float(row["end"])
