"""What the readers of AMASS-based annotations (KIT-ML, HumanML3D, BABEL) share: paths and split files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt_training.corpora.corpus import SPLITS


def read_json(path: Path) -> Any:
    """The content of a JSON file; FormatError with its line when it is not JSON, and a clear error when absent."""
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist; point to the folder with the annotation files")
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except json.JSONDecodeError as error:
        raise FormatError(path, f"not JSON: {error.msg}", error.lineno) from None


def read_splits(folder: Path) -> dict[str, str]:
    """``train.txt``, ``val.txt`` and ``test.txt`` (one key a line) -> split of every key."""
    splits: dict[str, str] = {}
    for split in SPLITS:
        path = folder / f"{split}.txt"
        if not path.is_file():
            raise MotionFileNotFoundError(f"{path} does not exist; the splits are one key a line in {split}.txt")
        splits |= dict.fromkeys(path.read_text(encoding="utf-8").split(), split)
    return splits


def amass_file(amass: Path, relative: str) -> Path | None:
    """``amass/relative`` as ``.npz``, or ``None`` when this copy of AMASS does not have it.

    Annotation files name sequences as ``KIT/3/kick_poses``, ``./pose_data/KIT/3/kick_poses.npy`` or with the data set
    twice (``KIT/KIT/3/kick_poses.npz``, BABEL); SMPL-X copies end in ``_stageii``.
    """
    parts = [part for part in Path(relative).with_suffix("").parts if part not in {".", "pose_data"}]
    for tail in (parts, parts[1:]):
        for ending in ("", "_stageii"):
            name = tail[-1].removesuffix("_poses") + ending if ending else tail[-1]
            path = amass.joinpath(*tail[:-1], f"{name}.npz")
            if path.is_file():
                return path
    return None
