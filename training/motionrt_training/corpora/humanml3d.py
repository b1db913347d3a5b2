"""HumanML3D annotations over an AMASS folder.

The folder holds ``index.csv`` (``source_path, start_frame, end_frame, new_name``; frames at 20 fps), ``texts/`` with a
``<name>.txt`` a motion (lines ``caption#tokens#start#end``; ``0#0`` means the whole motion) and ``train.txt``,
``val.txt``, ``test.txt``. A name with a leading ``M`` is a mirrored copy: this project mirrors by itself, so those rows
are left out, and so are sequences that the AMASS copy at hand does not have.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from pathlib import Path

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.amass import amass_file, read_splits
from motionrt_training.corpora.corpus import Clip, MotionCorpus

FPS = 20.0


def read_humanml3d(folder: str | Path, amass: str | Path) -> MotionCorpus:
    """The HumanML3D corpus; a caption of a part of a motion becomes a clip of its own."""
    root = Path(folder)
    splits = read_splits(root)
    clips: list[Clip] = []
    for row in _index(root / "index.csv"):
        name = Path(row["new_name"]).stem
        path = amass_file(Path(amass), row["source_path"])
        if name in splits and path is not None:
            clips += _clips(root / "texts" / f"{name}.txt", name, path, row, splits[name])
    return MotionCorpus("humanml3d", tuple(clips))


def _index(path: Path) -> list[dict[str, str]]:
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist; it maps HumanML3D names to AMASS sequences")
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _clips(texts: Path, name: str, motion: Path, row: dict[str, str], split: str) -> list[Clip]:
    start = float(row["start_frame"]) / FPS
    last = float(row["end_frame"])
    end = last / FPS if last >= 0 else None
    grouped: dict[tuple[float, float | None], list[str]] = defaultdict(list)
    for caption, part_start, part_end in _captions(texts):
        whole = part_start == part_end == 0
        grouped[(start, end) if whole else (start + part_start, start + part_end)].append(caption)
    return [
        Clip(name if index == 0 else f"{name}_{index}", motion, begin, stop, tuple(captions), split)
        for index, ((begin, stop), captions) in enumerate(grouped.items())
    ]


def _captions(path: Path) -> list[tuple[str, float, float]]:
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist, but the splits name this motion")
    rows = []
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not text.strip():
            continue
        try:
            caption, _, start, end = text.split("#")
            times = [0.0 if value == "nan" else float(value) for value in (start, end)]
        except ValueError:
            raise FormatError(path, "expected 'caption#tokens#start#end'", line) from None
        rows.append((caption.strip(), times[0], times[1]))
    return rows
