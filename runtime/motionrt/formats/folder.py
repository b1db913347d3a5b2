"""Motion files of a folder, each animation of a file that holds several as one of its own."""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError, MotionRTError
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.load import MOTION_SUFFIXES
from motionrt.untrusted.files import as_path

Stamp = tuple[int, int]
"""Size of a file in bytes, and its modification time in nanoseconds."""


@dataclass(frozen=True)
class FoundMotions:
    """What is below a folder; paths are relative to it, sorted, with forward slashes.

    Attributes:
        motions: size and time of every motion file.
        closed: folders that cannot be opened, and why.
        beside: size and time of the other files that were asked for.
    """

    motions: dict[str, Stamp]
    closed: list[tuple[str, str]]
    beside: dict[str, Stamp]

    @property
    def names(self) -> list[str]:
        """The motion files."""
        return list(self.motions)


def find_motions(folder: str | Path, *, without: str | None = None, beside: Collection[str] = ()) -> FoundMotions:
    """All motion files below ``folder``.

    Suffixes count in any case. Hidden files and folders are left out; linked folders are followed, each real folder
    once.

    Args:
        folder: where to look.
        without: folders below that hold a file of this name are left out.
        beside: names of other files to look for, lower case.

    Raises:
        MotionFileNotFoundError: no such folder.
        InvalidInputError: a file instead of a folder, or not one motion file in it.
    """
    folder = as_path(folder)
    if not folder.exists():
        raise MotionFileNotFoundError(f"no folder {folder}")
    if not folder.is_dir():
        raise InvalidInputError(f"{folder} is a file; give the folder that holds the motion files")
    found = FoundMotions({}, [], {})
    _walk(os.fspath(folder), without, beside, found)
    if not found.motions:
        raise InvalidInputError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {folder} or below it")
    return FoundMotions(dict(sorted(found.motions.items())), found.closed, dict(sorted(found.beside.items())))


def animations_of(path: str | Path) -> list[str]:
    """What the animations are called that move the skeleton, of a glTF or FBX file that holds several; else empty.

    A file that cannot be read has none: reading it says why.
    """
    path = as_path(path)
    try:
        if path.suffix.lower() in GLTF_SUFFIXES:
            from motionrt.formats.gltf.document import open_glb

            names = open_glb(path).animations
        elif path.suffix.lower() == ".fbx":
            from motionrt.formats.fbx import fbx_animations

            names = fbx_animations(path)
        else:
            return []
    except (MotionRTError, ValueError, KeyError, TypeError):
        return []
    return names if len(names) > 1 else []


def _walk(top: str, without: str | None, beside: Collection[str], found: FoundMotions) -> None:
    """Note what lies in a folder and below it."""
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
            found.closed.append((prefix.rstrip("/") or ".", f"cannot be opened: {error.strerror}"))
            continue
        if prefix and any(entry.name == without for entry in entries):
            continue
        seen.add(real)
        waiting += [f"{prefix}{name}/" for name in reversed(_noted(entries, prefix, beside, found))]


def _noted(entries: list[os.DirEntry[str]], prefix: str, beside: Collection[str], found: FoundMotions) -> list[str]:
    """Note the files of a folder; gives the names of its folders."""
    folders = []
    for entry in entries:
        if entry.name.startswith("."):
            continue
        if entry.is_dir():
            folders.append(entry.name)
        elif os.path.splitext(entry.name)[1].lower() in MOTION_SUFFIXES:  # noqa: PTH122 - a Path takes ten times as long
            found.motions[prefix + entry.name] = _stamp(entry)
        elif entry.name.lower() in beside:
            found.beside[prefix + entry.name] = _stamp(entry)
    return folders


def _stamp(entry: os.DirEntry[str]) -> Stamp:
    """Size and time; of a file that cannot be asked, as of a link to nothing, none that a file has."""
    try:
        stat = entry.stat()
    except OSError:
        return -1, -1
    return stat.st_size, stat.st_mtime_ns
