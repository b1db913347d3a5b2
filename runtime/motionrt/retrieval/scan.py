"""Which files of a folder are motions, and which are words about them."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError
from motionrt.formats import MOTION_SUFFIXES
from motionrt.retrieval.records import Skipped
from motionrt.retrieval.store import GALLERY_FILE

SIDECARS = ("captions.csv", "captions.jsonl")
Stamp = tuple[int, int]
"""Size in bytes and modification time in nanoseconds."""


@dataclass
class Found:
    """What a folder holds; paths are relative, with forward slashes.

    Attributes:
        motions: size and time of every motion file, in the order of their paths.
        sidecars: of every file of words.
        closed: folders that cannot be opened.
    """

    motions: dict[str, Stamp] = field(default_factory=dict)
    sidecars: dict[str, Stamp] = field(default_factory=dict)
    closed: list[Skipped] = field(default_factory=list)


def find_motion_files(folder: Path) -> Found:
    """Motion files and sidecars below ``folder``.

    Suffixes count in any case. Hidden files and folders and galleries are left out; linked folders are
    followed, each real folder once.

    Raises:
        MotionFileNotFoundError: no such folder.
        InvalidInputError: a file instead of a folder, or not one motion file in it.
    """
    if not folder.exists():
        raise MotionFileNotFoundError(f"no folder {folder}")
    if not folder.is_dir():
        raise InvalidInputError(f"{folder} is a file; give the folder that holds the motion files")
    found = Found()
    _walk(os.fspath(folder), found)
    found.motions = dict(sorted(found.motions.items()))
    found.sidecars = dict(sorted(found.sidecars.items()))
    if not found.motions:
        raise InvalidInputError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {folder} or below it")
    return found


def _walk(top: str, found: Found) -> None:
    """Add what lies in a folder and below it."""
    seen: set[str] = set()
    waiting = [""]  # paths below the first folder, each with a slash behind it
    while waiting:
        prefix = waiting.pop()
        real = os.path.realpath(f"{top}/{prefix}")
        if real in seen:
            continue
        try:
            with os.scandir(f"{top}/{prefix}") as listing:
                entries = sorted(listing, key=lambda entry: entry.name)
        except OSError as error:
            found.closed.append(Skipped(prefix.rstrip("/") or ".", f"cannot be opened: {error.strerror}"))
            continue
        if prefix and any(entry.name == GALLERY_FILE for entry in entries):
            continue
        seen.add(real)
        waiting += [f"{prefix}{name}/" for name in reversed(_sorted_in(entries, prefix, found))]


def _sorted_in(entries: list[os.DirEntry[str]], prefix: str, found: Found) -> list[str]:
    """Add the files of a folder; gives the names of its folders."""
    folders = []
    for entry in entries:
        if entry.name.startswith("."):
            continue
        if entry.is_dir():
            folders.append(entry.name)
        elif os.path.splitext(entry.name)[1].lower() in MOTION_SUFFIXES:  # noqa: PTH122 - a Path takes ten times as long
            found.motions[prefix + entry.name] = _stamp(entry)
        elif entry.name.lower() in SIDECARS:
            found.sidecars[prefix + entry.name] = _stamp(entry)
    return folders


def _stamp(entry: os.DirEntry[str]) -> Stamp:
    """Size and time; of a file that cannot be asked, as of a link to nothing, none that a file has."""
    try:
        stat = entry.stat()
    except OSError:
        return -1, -1
    return stat.st_size, stat.st_mtime_ns
