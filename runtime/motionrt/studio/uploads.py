"""Files that a window uploaded: kept in a folder of its own, which is removed with it, and read without any others."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.formats import MOTION_SUFFIXES
from motionrt.studio.project import plain_name
from motionrt.untrusted.files import confined

SCENE_SUFFIXES = (".yaml", ".yml", ".json", ".obj", ".ply", ".glb", ".stl", ".off")
"""What is opened at once; anything else is kept for a script or a map that names it."""

_PICTURES = (".pgm", ".png", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff")
_KEPT = tuple(dict.fromkeys((*SCENE_SUFFIXES, *MOTION_SUFFIXES, ".asf", ".bin", ".csv", *_PICTURES)))
_MOST = 100  # files of a window


class Uploads:
    """The uploads of one window."""

    def __init__(self) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def keep(self, name: str, content: bytes) -> Path:
        """Write a file; returns where.

        Raises:
            InvalidInputError: no file of such a kind is read, or there are too many.
        """
        plain = plain_name(name)
        if Path(plain).suffix.lower() not in _KEPT:
            raise InvalidInputError(f"what is read is one of {', '.join(_KEPT)}")
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="motionrt-", ignore_cleanup_errors=True)
        folder = Path(self._folder.name)
        if len(list(folder.iterdir())) >= _MOST:
            raise InvalidInputError(f"{_MOST} files are enough for one window; open another")
        file = folder / plain
        file.write_bytes(content)
        return file

    @contextmanager
    def alone(self) -> Iterator[None]:
        """While this holds no file is read but the uploaded ones, and messages do not say where they lie."""
        folder = "" if self._folder is None else self._folder.name
        try:
            with confined(Path(folder)):
                yield
        except MotionRTError as error:
            words = str(error).replace(f"{folder}/", "").replace(f"{folder}\\", "").replace(folder, "")
            raise InvalidInputError(words) from error

    def close(self) -> None:
        """Remove them all."""
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None
