"""HumanML3D annotations over an AMASS folder, in three layouts.

* The repository: ``index.csv`` beside the folder ``HumanML3D/``, which holds ``texts/`` and the splits. Either folder
  may be named.
* One folder of its own with ``index.csv``, ``texts/``, ``train.txt``, ``val.txt`` and ``test.txt``.
* ``annotations.json`` with ``splits/`` (:mod:`motionrt_training.corpora.captions`).

``index.csv`` has ``source_path, start_frame, end_frame, new_name`` (frames at 20 fps, after the first cut below),
``texts/<name>.txt`` has lines ``caption#tokens#start#end`` (seconds of the cut motion; ``0#0`` means all of it). A name
with a leading ``M`` is a mirrored copy, which is left out, as training mirrors by itself.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.amass import amass_file, read_splits, require_amass, require_some, sequence_name
from motionrt_training.corpora.captions import MIRRORED, NO_SPLIT, NO_TEXT, Captioned, clips_of, read_annotations
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

FPS = 20.0
FIRST_CUTS = {
    "Eyes_Japan_Dataset": 3.0,
    "MPI_HDM05": 3.0,
    "TotalCapture": 1.0,
    "MPI_Limits": 1.0,
    "Transitions_mocap": 0.5,
}
"""Seconds that HumanML3D cuts off sequences of these data sets before it counts frames."""
HUMANACT12 = "humanact12"
NO_JOINTS = "HumanAct12, whose joints are not there; unpack pose_data/humanact12.zip of the HumanML3D repository"


def read_humanml3d(folder: str | Path, amass: str | Path) -> MotionCorpus:
    """The HumanML3D corpus; a caption of a part of a motion becomes a clip of its own.

    Raises:
        MotionFileNotFoundError: no such layout in ``folder``, or none of its sequences in ``amass``.
        FormatError: a damaged row, with its file and line.
    """
    root, copy = Path(folder), require_amass(amass)
    if (root / "annotations.json").is_file():
        return read_annotations("humanml3d", root, copy)
    index, annotated, layout = _layout(root)
    splits = read_splits(annotated)
    report = ReadReport("humanml3d", layout)
    clips: list[Clip] = []
    for row in _index(index):
        report.rows += 1
        clips += _Row(row, index).clips(annotated / "texts", copy, splits, report)
    report.count(clip.split for clip in clips)
    require_some(report, copy)
    return MotionCorpus("humanml3d", tuple(clips), report=report)


def _layout(root: Path) -> tuple[Path, Path, str]:
    """``index.csv``, the folder with ``texts/`` and splits, and the name of the layout."""
    places = (
        (root / "index.csv", root / "HumanML3D", "repository"),
        (root.parent / "index.csv", root, "repository"),
        (root / "index.csv", root, "one folder"),
    )
    known = [place for place in places if place[0].is_file()]
    whole = [place for place in known if (place[1] / "texts").is_dir()]
    if whole:
        return whole[-1]
    zipped = next((place[1] / "texts.zip" for place in known if (place[1] / "texts.zip").is_file()), None)
    if zipped is not None:
        raise MotionFileNotFoundError(f"{zipped.with_suffix('')} does not exist; unpack {zipped}")
    raise MotionFileNotFoundError(
        f"{root} is not HumanML3D: it has neither index.csv with texts/ (here, or in HumanML3D/) and train.txt, "
        f"nor annotations.json with splits/"
    )


def _index(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class _Row:
    """A row of ``index.csv``."""

    def __init__(self, row: dict[str, str], index: Path) -> None:
        try:
            self.source, self.name = row["source_path"], Path(row["new_name"]).stem
            first, last = float(row["start_frame"]), float(row["end_frame"])
        except (KeyError, TypeError, ValueError) as error:
            raise FormatError(index, f"row of '{row.get('new_name')}' misses or garbles {error}") from None
        self.of_humanact12 = HUMANACT12 in self.source
        found = (cut for name, cut in FIRST_CUTS.items() if name in self.source)
        self.cut = 0.0 if self.of_humanact12 else next(found, 0.0)
        self.start = first / FPS + self.cut
        self.end = last / FPS + self.cut if last >= 0 else None
        self.pose_data = index.parent / "pose_data"

    def clips(self, texts: Path, amass: Path, splits: dict[str, str], report: ReadReport) -> list[Clip]:
        """Its clips, or none and why."""
        if self.name not in splits or self.name.startswith("M"):
            report.skip(self.name, MIRRORED if self.name.startswith("M") else NO_SPLIT)
            return []
        path = self._joints() if self.of_humanact12 else amass_file(amass, self.source)
        if path is None:
            if self.of_humanact12:
                report.skip(self.name, NO_JOINTS)
            else:
                report.missing.append(sequence_name(self.source))
            return []
        captions = _captions(texts / f"{self.name}.txt", report)
        if not captions:
            report.skip(self.name, NO_TEXT)
        if self.cut:
            report.notes[f"first {self.cut:g} s cut off"] += 1
        return clips_of(self.name, path, [self._placed(*one) for one in captions], splits[self.name])

    def _placed(self, caption: str, start: float, end: float | None) -> Captioned:
        """A caption in seconds of the sequence: within the row's stretch."""
        if start == end == 0.0 or end is None:
            return caption, self.start, self.end
        last = self.start + end
        begin = self.start + start
        last = last if self.end is None else min(self.end, last)
        return (caption, begin, last) if last > begin else (caption, self.start, self.end)

    def _joints(self) -> Path | None:
        name = Path(self.source).name
        places = (self.pose_data / HUMANACT12 / HUMANACT12 / name, self.pose_data / HUMANACT12 / name)
        return next((path for path in places if path.is_file()), None)


def _captions(path: Path, report: ReadReport) -> list[Captioned]:
    """Captions with their seconds; swapped times are put right, equal ones mean the whole motion."""
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist, but the splits name this motion")
    rows: list[Captioned] = []
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        if not text.strip():
            continue
        try:
            caption, _, *times = text.split("#")
            first, last = (0.0 if math.isnan(value) else value for value in map(float, times))
        except ValueError:
            raise FormatError(path, "expected 'caption#tokens#start#end'", line) from None
        if first > last:
            report.notes["captions whose times were swapped"] += 1
            first, last = last, first
        if first == last != 0.0:
            report.notes["captions with equal times, taken for the whole motion"] += 1
            first = last = 0.0
        if caption.strip():
            rows.append((caption.strip(), first, last))
    return rows
