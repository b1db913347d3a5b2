"""What the readers of AMASS-based annotations (KIT-ML, HumanML3D, BABEL) share: paths, split files, AMASS itself.

AMASS is published twice: with SMPL-H bodies (``KIT/3/kick_poses.npz``) and with SMPL-X bodies, whose folders and files
have other names (``BMLrub`` for ``BioMotionLab_NTroje``, ``A1_-_Stand_stageii.npz`` for ``A1 - Stand_poses.npz``).
Annotations name the first; either copy is read.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.corpus import SPLITS, Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

RENAMED = {
    "BioMotionLab_NTroje": "BMLrub",
    "DFaust_67": "DFaust",
    "Eyes_Japan_Dataset": "EyesJapanDataset",
    "MPI_HDM05": "HDM05",
    "MPI_Limits": "PosePrior",
    "MPI_mosh": "MoSh",
    "SSM_synced": "SSM",
    "TCD_handMocap": "TCDHands",
    "Transitions_mocap": "Transitions",
}
"""Folders of the SMPL-H copy -> the same of the SMPL-X copy."""
_FORMER = {new: old for old, new in RENAMED.items()}

_SPACES = (" ", "_", "-")  # what stands for a space of the SMPL-H copy
_VALIDATION = {"HumanEva", "MPI_HDM05", "SFU", "MPI_mosh"}
_TEST = {"Transitions_mocap", "SSM_synced"}


def former_name(folder: str) -> str:
    """The name of a data set of AMASS in the SMPL-H copy."""
    return _FORMER.get(folder, folder)


def published_split(sequence: str) -> str:
    """``train``, ``val`` or ``test`` of a sequence as AMASS recommends it, which is by data set."""
    folder = former_name(Path(sequence).parts[0])
    return "val" if folder in _VALIDATION else "test" if folder in _TEST else "train"


def read_json(path: Path) -> Any:
    """The content of a JSON file; FormatError with its line when it is not JSON, and a clear error when absent."""
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist; point to the folder with the annotation files")
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise FormatError(path, f"not JSON: {error.msg}", error.lineno) from None


def read_splits(folder: Path) -> dict[str, str]:
    """``train.txt``, ``val.txt`` and ``test.txt`` (one key a line), here or in ``splits/`` -> split of every key."""
    place = folder / "splits" if (folder / "splits" / "train.txt").is_file() else folder
    splits: dict[str, str] = {}
    for split in SPLITS:
        path = place / f"{split}.txt"
        if not path.is_file():
            raise MotionFileNotFoundError(f"{path} does not exist; the splits are one key a line in {split}.txt")
        splits |= dict.fromkeys(path.read_text(encoding="utf-8").split(), split)
    return splits


def require_amass(folder: str | Path) -> Path:
    """The folder of an AMASS copy, which holds ``KIT/``, ``CMU/`` and so on."""
    path = Path(folder)
    if not path.is_dir():
        raise MotionFileNotFoundError(f"{path} is no folder; name the AMASS folder, which holds KIT/, CMU/, ACCAD/ ...")
    return path


def require_some(report: ReadReport, amass: Path) -> None:
    """One clear error where an AMASS folder has none of the sequences that annotations name."""
    if report.missing and not report.found:
        raise MotionFileNotFoundError(
            f"none of the {len(report.missing)} sequences of {report.corpus} lie in {amass}, which has no "
            f"{report.missing[0]}; name the folder that holds the data sets of AMASS (KIT/, CMU/, ACCAD/ ...)"
        )


def amass_file(amass: Path, relative: str) -> Path | None:
    """``amass/relative`` as ``.npz``, or ``None`` when this copy of AMASS does not have it.

    Annotation files name sequences as ``KIT/3/kick_poses``, ``./pose_data/KIT/3/kick_poses.npy`` or with the data set
    twice (``KIT/KIT/3/kick_poses.npz``, BABEL), as some copies do, too.
    """
    return next((path for path in _places(amass, relative) if path.is_file()), None)


def sequence_name(relative: str) -> str:
    """A sequence as all annotations could name it: without ``pose_data``, suffix and repeated data set."""
    parts = _parts(relative)
    return "/".join(parts[1:] if len(parts) > 2 and parts[0] == parts[1] else parts)


def _parts(relative: str) -> list[str]:
    name = relative.removesuffix(".npz").removesuffix(".npy")  # a name may hold other dots
    return [part for part in name.split("/") if part not in {"", ".", "pose_data"}]


def _places(amass: Path, relative: str) -> Iterator[Path]:
    first, *rest = sequence_name(relative).split("/")
    stem = rest[-1].removesuffix("_poses").removesuffix("_stageii") if rest else first
    names = dict.fromkeys((rest[-1] if rest else first, f"{stem}_stageii", f"{stem}_poses"))
    folders = dict.fromkeys((first, RENAMED.get(first, first), former_name(first)))
    for folder, name, space in product(folders, names, _SPACES):
        inner = [part.replace(" ", space) for part in (*rest[:-1], f"{name}.npz")]
        yield amass.joinpath(folder, *inner)
        yield amass.joinpath(folder, folder, *inner)


def read_amass(folder: str | Path) -> MotionCorpus:
    """AMASS alone, without captions: every sequence is one clip, its text the words of its file name.

    Splits are those that AMASS recommends. Body shapes and calibrations (``shape.npz``, ``*_stagei.npz``) are left out.
    """
    amass = require_amass(folder)
    report = ReadReport("amass", "sequences")
    clips = []
    for path in sorted(amass.rglob("*.npz")):
        name = path.relative_to(amass).as_posix()
        if path.stem in {"shape", "neutral_shape"} or path.stem.endswith("_stagei"):
            report.skip(name, "a body shape, not a motion")
            continue
        report.rows += 1
        words = path.stem.removesuffix("_poses").removesuffix("_stageii").replace("_", " ").strip() or "motion"
        clips.append(Clip(name.removesuffix(".npz"), path, 0.0, None, (words,), published_split(name)))
    if not clips:
        raise MotionFileNotFoundError(f"{amass} holds no .npz of a motion; name the AMASS folder (KIT/, CMU/ ...)")
    report.count(clip.split for clip in clips)
    return MotionCorpus("amass", tuple(clips), report=report)
