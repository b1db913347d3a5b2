"""BABEL annotations over an AMASS folder: ``train.json``, ``val.json`` (and ``test.json`` where it is given).

Every sequence has ``feat_p`` (its AMASS path), ``dur`` and labels: ``frame_ann`` with ``start_t`` and ``end_t`` per
action, or ``seq_ann`` for the whole sequence. A frame label becomes a clip of its own stretch; labels that overlap it
by more than half of its length are listed as simultaneous. Transitions are left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.amass import amass_file, read_json
from motionrt_training.corpora.corpus import SPLITS, Clip, MotionCorpus

_IGNORED = {"transition"}


def read_babel(folder: str | Path, amass: str | Path) -> MotionCorpus:
    """The BABEL corpus; its files are its splits."""
    files = [(split, Path(folder) / f"{split}.json") for split in SPLITS]
    present = [(split, path) for split, path in files if path.is_file()]
    if not present:
        raise MotionFileNotFoundError(f"{folder} holds none of train.json, val.json, test.json")
    clips: list[Clip] = []
    for split, path in present:
        for key, entry in read_json(path).items():
            try:
                clips += _sequence(key, entry, Path(amass), split)
            except (KeyError, TypeError) as error:
                raise FormatError(path, f"sequence '{key}' misses or garbles {error}") from None
    return MotionCorpus("babel", tuple(clips))


def _sequence(key: str, entry: dict[str, Any], amass: Path, split: str) -> list[Clip]:
    path = amass_file(amass, entry["feat_p"])
    spans = _spans(entry)
    if path is None:
        return []
    return [
        Clip(f"{key}_{index}", path, start, end, (text,), split, _simultaneous(index, spans))
        for index, (text, start, end) in enumerate(spans)
    ]


Span = tuple[str, float, float]


def _spans(entry: dict[str, Any]) -> list[Span]:
    frames = entry.get("frame_ann")
    whole = 0.0, float(entry["dur"])
    if frames:
        spans = [(_text(label), float(label["start_t"]), float(label["end_t"])) for label in frames["labels"]]
    else:
        spans = [(_text(label), *whole) for label in (entry.get("seq_ann") or {"labels": []})["labels"]]
    return [span for span in spans if span[0] and span[0] not in _IGNORED and span[2] > span[1]]


def _text(label: dict[str, Any]) -> str:
    return str(label.get("raw_label") or label.get("proc_label") or "").strip()


def _simultaneous(index: int, spans: list[Span]) -> tuple[str, ...]:
    """The label of ``index`` and those that overlap it by more than half of its length."""
    text, start, end = spans[index]
    others = (
        other for at, (other, begin, stop) in enumerate(spans)
        if at != index and min(end, stop) - max(start, begin) > (end - start) / 2
    )  # fmt: skip
    return (text, *others)
