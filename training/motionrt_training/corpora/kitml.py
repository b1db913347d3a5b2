"""KIT Motion-Language annotations over an AMASS folder.

Two layouts are read. The data set's own: ``<id>_annotations.json`` (a list of sentences) and ``<id>_meta.json`` per
motion, with ``amass_paths.json`` (id -> AMASS sequence) beside them. The unified one: a single ``annotations.json``,
id -> ``{"path", "annotations": [{"text", "start", "end"}]}``. Splits are ``train.txt``, ``val.txt``, ``test.txt`` with
one id a line. Motions without a sentence, or which the AMASS copy at hand does not have, are left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from motionrt.errors import FormatError
from motionrt_training.corpora.amass import amass_file, read_json, read_splits
from motionrt_training.corpora.corpus import Clip, MotionCorpus


def read_kitml(folder: str | Path, amass: str | Path) -> MotionCorpus:
    """The KIT-ML corpus, every motion with all of its sentences."""
    root = Path(folder)
    splits = read_splits(root)
    unified = root / "annotations.json"
    rows = _unified(unified) if unified.is_file() else _original(root, sorted(splits))
    clips = []
    for key, sequence, start, end, texts in rows:
        path = amass_file(Path(amass), sequence)
        if path is not None and texts and key in splits:
            clips.append(Clip(key, path, start, end, texts, splits[key]))
    return MotionCorpus("kitml", tuple(clips))


Row = tuple[str, str, float, float | None, tuple[str, ...]]


def _unified(path: Path) -> list[Row]:
    rows: list[Row] = []
    for key, entry in read_json(path).items():
        try:
            rows.append(_unified_row(key, entry))
        except (KeyError, TypeError) as error:
            raise FormatError(path, f"entry '{key}' misses or garbles {error}") from None
    return rows


def _unified_row(key: str, entry: dict[str, Any]) -> Row:
    parts = entry["annotations"]
    start = min((float(part["start"]) for part in parts), default=0.0)
    end = max((float(part["end"]) for part in parts), default=None)
    return key, entry["path"], start, end, tuple(part["text"] for part in parts)


def _original(folder: Path, keys: list[str]) -> list[Row]:
    paths = read_json(folder / "amass_paths.json")
    known = [key for key in keys if key in paths]
    return [(key, paths[key], 0.0, None, tuple(read_json(folder / f"{key}_annotations.json"))) for key in known]
