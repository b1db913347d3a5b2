"""Motion files of a folder, each animation of a file that holds several as one of its own."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError, MotionRTError
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.load import MOTION_SUFFIXES
from motionrt.untrusted.files import as_path


@dataclass(frozen=True)
class FoundMotions:
    """What is below a folder.

    Attributes:
        names: motion files, sorted relative paths with forward slashes.
        closed: folders that cannot be opened, and why.
    """

    names: list[str]
    closed: list[tuple[str, str]]


def find_motions(folder: str | Path, *, without: str | None = None) -> FoundMotions:
    """All motion files below ``folder``.

    Suffixes count in any case. Hidden files and folders are left out; linked folders are followed, each real folder
    once.

    Args:
        folder: where to look.
        without: folders below that hold a file of this name are left out.

    Raises:
        MotionFileNotFoundError: no such folder.
        InvalidInputError: a file instead of a folder, or not one motion file in it.
    """
    folder = as_path(folder)
    if not folder.exists():
        raise MotionFileNotFoundError(f"no folder {folder}")
    if not folder.is_dir():
        raise InvalidInputError(f"{folder} is a file; give the folder that holds the motion files")
    closed: list[tuple[str, str]] = []
    found = sorted(path.relative_to(folder).as_posix() for path in _walk(folder, without, closed))
    if not found:
        raise InvalidInputError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {folder} or below it")
    return FoundMotions(found, closed)


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


def _walk(folder: Path, without: str | None, closed: list[tuple[str, str]]) -> Iterator[Path]:
    def note(error: OSError) -> None:
        place = Path(str(error.filename)).relative_to(folder).as_posix()
        closed.append((place, f"cannot be opened: {error.strerror}"))

    seen: set[str] = set()
    for place, folders, files in os.walk(folder, followlinks=True, onerror=note):
        real = os.path.realpath(place)
        if real in seen or (without in files and Path(place) != folder):
            folders.clear()
            continue
        seen.add(real)
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from (Path(place, name) for name in files if _is_motion(name))


def _is_motion(name: str) -> bool:
    return not name.startswith(".") and Path(name).suffix.lower() in MOTION_SUFFIXES
