"""Which ASF skeleton, and which frame rate, belongs to an AMC file that names neither."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, MotionFileNotFoundError, MotionRTError
from motionrt.formats.acclaim.asf import AsfSkeleton, read_asf
from motionrt.untrusted.files import is_confined

DEFAULT_FPS = 120.0
"""The rate of the CMU database, whose AMC files do not state it."""


def find_asf(amc: Path) -> AsfSkeleton:
    """The skeleton for an AMC file.

    Looked for in the file's own folder, then in ``asf`` beside that folder: ``<trial>.asf``, then
    ``<subject>.asf`` (``16_03.amc`` -> ``16.asf``). If there is none, a stand-in is taken: ``default.asf``,
    else, of all skeletons there, the one whose legs are of median length (of an even number the shorter one;
    of equals the first by name). Its bone lengths are approximate; the choice depends on the folder alone.
    """
    folders = [amc.parent] if is_confined() else [amc.parent, amc.parent.parent / "asf"]
    names = [amc.stem, amc.stem.rsplit("_", 1)[0], amc.stem.split("_")[0], "default"]
    for name in dict.fromkeys(names):
        for folder in folders:
            match = next((path for path in _asf_files(folder) if path.stem == name), None)
            if match is not None:
                return read_asf(match)
    for folder in folders:
        stand_in = _median_legs(_asf_files(folder))
        if stand_in is not None:
            return stand_in
    looked = " or ".join(str(folder) for folder in folders)
    raise MotionFileNotFoundError(f"no .asf skeleton for {amc}: looked in {looked}; give one with asf=")


def find_fps(amc: Path) -> float:
    """The trial's rate from an ``index.csv`` with ``trial`` and ``fps``, here or one folder up; else 120."""
    for folder in (amc.parent,) if is_confined() else (amc.parent, amc.parent.parent):
        index = folder / "index.csv"
        if index.is_file():
            fps = _indexed_fps(index, amc.stem)
            if fps is not None:
                return fps
    return DEFAULT_FPS


def _indexed_fps(index: Path, trial: str) -> float | None:
    try:
        with index.open(encoding="utf-8", newline="") as file:
            row = next((row for row in csv.DictReader(file) if row.get("trial") == trial), None)
    except (OSError, UnicodeDecodeError, csv.Error):
        return None
    if row is None or not row.get("fps"):
        return None
    try:
        fps = float(row["fps"])
    except ValueError:
        fps = 0.0
    if not 1 <= fps <= 1000:
        raise FormatError(index, f"trial '{trial}' has fps '{row['fps']}'")
    return fps


def _asf_files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    return sorted(path for path in folder.iterdir() if path.suffix.lower() == ".asf")


def _median_legs(paths: Iterable[Path]) -> AsfSkeleton | None:
    skeletons = [skeleton for skeleton in map(_readable, paths) if skeleton is not None]
    if not skeletons:
        return None
    lengths = np.array([_leg_length(skeleton) for skeleton in skeletons])
    return skeletons[int(np.argsort(lengths, kind="stable")[(len(lengths) - 1) // 2])]


def _readable(path: Path) -> AsfSkeleton | None:
    try:
        return read_asf(path)
    except MotionRTError:
        return None


def _leg_length(skeleton: AsfSkeleton) -> float:
    """Length of the thighs and shins, or of all bones where they have other names; in comparable units."""
    legs = [b.length for n, b in skeleton.bones.items() if n in ("lfemur", "ltibia", "rfemur", "rtibia")]
    return sum(legs or [bone.length for bone in skeleton.bones.values()]) / skeleton.length_unit
