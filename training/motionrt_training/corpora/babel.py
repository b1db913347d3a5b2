"""BABEL annotations over an AMASS folder: ``train.json``, ``val.json``, ``test.json`` and their ``extra_`` files.

Every sequence has ``feat_p`` (its AMASS path), ``dur`` and labels: ``frame_ann`` with ``start_t`` and ``end_t`` per
action, or ``seq_ann`` for the whole sequence; the ``extra_`` files have lists of them, ``frame_anns`` and ``seq_anns``,
one of each annotator. A label has ``raw_label`` (as it was typed), ``proc_label`` (spelt alike) and ``act_cat`` (its
categories). A frame label becomes a clip of its own stretch; labels that overlap it by more than half of its length are
listed as simultaneous. Transitions and calibration poses are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt_training.corpora.amass import amass_file, read_json, require_amass, require_some, sequence_name
from motionrt_training.corpora.captions import NO_TEXT
from motionrt_training.corpora.corpus import SPLITS, Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

SPELLINGS = ("raw", "proc")
IGNORED = frozenset({"transition", "t-pose", "a-pose", "t pose", "a pose", "tpose", "apose"})
LEFT_OUT = "transitions and calibration poses"


@dataclass(frozen=True)
class Label:
    """An action and when it happens, in seconds."""

    text: str
    start: float
    end: float
    categories: tuple[str, ...] = ()


Clips = Callable[[str, Path, list[Label], str, ReadReport], Iterable[Clip]]
"""Id of a sequence, its file, its labels, its split -> its clips."""


def read_babel(folder: str | Path, amass: str | Path, *, spelling: str = "raw", whole: bool = False) -> MotionCorpus:
    """The BABEL corpus; its files are its splits, ``extra_`` files add to theirs.

    Args:
        folder: holds the JSON files.
        amass: the AMASS copy.
        spelling: labels as they were typed (``"raw"``), or spelt alike (``"proc"``).
        whole: take labels of the whole sequence also where there are labels of its parts.

    Raises:
        MotionFileNotFoundError: no such files, or none of their sequences in ``amass``.
        FormatError: a damaged sequence, with its file and id.
    """
    return read_sequences("babel", folder, amass, _clips, spelling, whole=whole)


def read_sequences(
    name: str, folder: str | Path, amass: str | Path, clips_of: Clips, spelling: str, *, whole: bool = False
) -> MotionCorpus:
    """The clips that ``clips_of`` makes of every sequence."""
    if spelling not in SPELLINGS:
        raise InvalidInputError(f"BABEL has no '{spelling}' labels; there are {' and '.join(SPELLINGS)}")
    copy = require_amass(amass)
    present = _files(Path(folder))
    report = ReadReport(name, " ".join(path.name for _, path in present))
    clips: list[Clip] = []
    for split, path in present:
        for key, entry in read_json(path).items():
            report.rows += 1
            try:
                labels, sequence = _labels(entry, f"{spelling}_label", report, whole=whole), str(entry["feat_p"])
            except (KeyError, TypeError, ValueError) as error:
                raise FormatError(path, f"sequence '{key}' misses or garbles {error}") from None
            file = amass_file(copy, sequence)
            if not labels:
                report.skip(key, NO_TEXT)
            elif file is None:
                report.missing.append(sequence_name(sequence))
            else:
                clips += clips_of(key, file, labels, split, report)
    report.count(clip.split for clip in clips)
    require_some(report, copy)
    return MotionCorpus(name, tuple(clips), report=report)


def _files(folder: Path) -> list[tuple[str, Path]]:
    files = [(split, folder / f"{start}{split}.json") for split in SPLITS for start in ("", "extra_")]
    present = [(split, path) for split, path in files if path.is_file()]
    if not present:
        raise MotionFileNotFoundError(f"{folder} is not BABEL: it holds none of train.json, val.json, test.json")
    return present


def _labels(entry: dict[str, Any], spelling: str, report: ReadReport, *, whole: bool) -> list[Label]:
    """The labels of a sequence's parts, or, where there are none, those of all of it."""
    seconds = float(entry["dur"])
    parts = [row for labels in _annotators(entry, "frame_ann") for row in labels]
    rows = [(row, float(row["start_t"]), min(float(row["end_t"]), seconds)) for row in parts]
    if not rows or whole:
        rows += [(row, 0.0, seconds) for labels in _annotators(entry, "seq_ann")[:1] for row in labels]
    labels = [Label(_text(row, spelling), start, end, tuple(row.get("act_cat") or ())) for row, start, end in rows]
    kept = [label for label in labels if label.text.lower() not in IGNORED]
    if len(kept) < len(labels):
        report.notes[f"{LEFT_OUT} left out"] += len(labels) - len(kept)
    return list(dict.fromkeys(label for label in kept if label.text and label.end > label.start))


def _annotators(entry: dict[str, Any], kind: str) -> list[list[dict[str, Any]]]:
    """The labels of every annotator: one in the dense files, several in the ``extra_`` ones."""
    several = entry.get(f"{kind}s")
    found = several if several is not None else [entry.get(kind)]
    return [list(annotation["labels"]) for annotation in found if annotation]


def _text(row: dict[str, Any], spelling: str) -> str:
    other = "raw_label" if spelling == "proc_label" else "proc_label"
    return str(row.get(spelling) or row.get(other) or "").strip()


def _clips(key: str, path: Path, labels: list[Label], split: str, _: ReadReport) -> list[Clip]:
    return [
        Clip(
            f"{key}_{number}", path, label.start, label.end, (label.text,), split, _simultaneous(number, labels),
            categories=label.categories,
        )
        for number, label in enumerate(labels)
    ]  # fmt: skip


def _simultaneous(number: int, labels: list[Label]) -> tuple[str, ...]:
    """The label of ``number`` and those that overlap it by more than half of its length."""
    own = labels[number]
    others = (
        other.text for at, other in enumerate(labels)
        if at != number and min(own.end, other.end) - max(own.start, other.start) > (own.end - own.start) / 2
    )  # fmt: skip
    return (own.text, *others)
