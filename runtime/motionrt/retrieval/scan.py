"""Which files of a folder are motions."""

from __future__ import annotations

import os
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError
from motionrt.formats import MOTION_SUFFIXES
from motionrt.retrieval.records import Skipped
from motionrt.retrieval.store import GALLERY_FILE


def find_motion_files(folder: Path) -> tuple[list[str], list[Skipped]]:
    """Motion files below ``folder``, sorted relative paths with forward slashes; and what cannot be opened.

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
    closed: list[Skipped] = []
    found = sorted(path.relative_to(folder).as_posix() for path in _walk(folder, closed))
    if not found:
        raise InvalidInputError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {folder} or below it")
    return found, closed


def _walk(folder: Path, closed: list[Skipped]) -> list[Path]:
    def note(error: OSError) -> None:
        place = Path(str(error.filename)).relative_to(folder).as_posix()
        closed.append(Skipped(place, f"cannot be opened: {error.strerror}"))

    found: list[Path] = []
    seen: set[str] = set()
    for place, folders, files in os.walk(folder, followlinks=True, onerror=note):
        real = os.path.realpath(place)
        if real in seen or (GALLERY_FILE in files and Path(place) != folder):
            folders.clear()
            continue
        seen.add(real)
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        found += [Path(place, name) for name in files if _is_motion(name)]
    return found


def _is_motion(name: str) -> bool:
    return not name.startswith(".") and Path(name).suffix.lower() in MOTION_SUFFIXES
