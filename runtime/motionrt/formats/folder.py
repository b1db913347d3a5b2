"""Motion files of a folder, each animation of a file that holds several as one of its own."""

from __future__ import annotations

import os
from pathlib import Path

from motionrt.errors import MotionFileNotFoundError, MotionRTError
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.load import MOTION_SUFFIXES
from motionrt.untrusted.files import as_path


def find_motions(folder: str | Path) -> list[tuple[str, str | None]]:
    """All motions below ``folder``: sorted relative path with forward slashes, and animation (where there are several).

    Hidden files and folders are left out.

    Raises:
        MotionFileNotFoundError: no such folder, or not one motion file in it.
    """
    folder = as_path(folder)
    names = []
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        motions = [name for name in files if not name.startswith(".") and _suffix(name) in MOTION_SUFFIXES]
        names += [(Path(place) / name).relative_to(folder).as_posix() for name in motions]
    if not names:
        raise MotionFileNotFoundError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {folder} or below it")
    out: list[tuple[str, str | None]] = []
    for name in sorted(names):
        out += [(name, animation) for animation in animations_of(folder / name)] or [(name, None)]
    return out


def animations_of(path: str | Path) -> list[str]:
    """Names of the animations that move the skeleton, of a glTF or FBX file that holds several; else empty.

    A file that cannot be read has none: reading it says why.
    """
    path = as_path(path)
    try:
        if _suffix(path.name) in GLTF_SUFFIXES:
            from motionrt.formats.gltf.document import open_glb

            names = open_glb(path).animations
        elif _suffix(path.name) == ".fbx":
            from motionrt.formats.fbx import fbx_animations

            names = fbx_animations(path)
        else:
            return []
    except (MotionRTError, ValueError, KeyError, TypeError):
        return []
    return names if len(names) > 1 else []


def _suffix(name: str) -> str:
    return Path(name).suffix.lower()
