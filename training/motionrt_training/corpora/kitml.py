"""KIT Motion-Language annotations over an AMASS folder.

Two layouts are read. The data set's own: ``<id>_annotations.json`` (a list of sentences) per motion, with
``amass_paths.json`` or ``amass-path2kitml.json`` (id -> AMASS sequence) beside them and ``train.txt``, ``val.txt``,
``test.txt`` with one id a line, here or in ``splits/``. The unified one: ``annotations.json`` with the same splits
(:mod:`motionrt_training.corpora.captions`).
"""

from __future__ import annotations

from pathlib import Path

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.amass import (
    amass_file,
    read_json,
    read_splits,
    require_amass,
    require_some,
    sequence_name,
)
from motionrt_training.corpora.captions import NO_TEXT, clips_of, read_annotations
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

PATHS = ("amass_paths.json", "amass-path2kitml.json")
NO_PATH = "has no AMASS sequence in the file of paths"


def read_kitml(folder: str | Path, amass: str | Path) -> MotionCorpus:
    """The KIT-ML corpus, every motion with all of its sentences.

    Raises:
        MotionFileNotFoundError: no such layout in ``folder``, or none of its sequences in ``amass``.
        FormatError: an annotation file that is damaged.
    """
    root, copy = Path(folder), require_amass(amass)
    if (root / "annotations.json").is_file():
        return read_annotations("kitml", root, copy)
    return _own(root, copy)


def _own(root: Path, amass: Path) -> MotionCorpus:
    splits = read_splits(root)
    source = next((root / name for name in PATHS if (root / name).is_file()), None)
    if source is None:
        raise MotionFileNotFoundError(f"{root / PATHS[0]} does not exist; it maps ids of KIT-ML to AMASS sequences")
    paths = read_json(source)
    report = ReadReport("kitml", "one file a motion", len(splits))
    clips: list[Clip] = []
    for key in sorted(splits):
        texts = _sentences(root / f"{key}_annotations.json") if key in paths else []
        path = amass_file(amass, paths[key]) if key in paths else None
        if key not in paths or not texts:
            report.skip(key, NO_TEXT if key in paths else NO_PATH)
        elif path is None:
            report.missing.append(sequence_name(paths[key]))
        else:
            clips += clips_of(key, path, [(text, 0.0, None) for text in texts], splits[key])
    report.count(clip.split for clip in clips)
    require_some(report, amass)
    return MotionCorpus("kitml", tuple(clips), report=report)


def _sentences(path: Path) -> list[str]:
    found = read_json(path)
    if not isinstance(found, list):
        raise FormatError(path, "expected a list of sentences")
    return [str(text).strip() for text in found if str(text).strip()]
