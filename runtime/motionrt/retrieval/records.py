"""What a gallery remembers of its clips."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

WINDOW_TYPE = np.dtype([("clip", "<i4"), ("start_s", "<f4"), ("end_s", "<f4")])
WindowTable = npt.NDArray[np.void]


@dataclass(frozen=True)
class Clip:
    """One motion of a gallery.

    Attributes:
        id: unique name; for a file its path below the indexed folder, with forward slashes, and ``#animation`` after it
            where the file holds several.
        duration_s: length in seconds.
        size: bytes of the file, 0 without one.
        mtime_ns: modification time of the file, nanoseconds, 0 without one.
        sha256: checksum of the file, empty without one.
        text: what the clip shows, where that is known.
        animation: name or index of the clip's animation in a file that holds several.
    """

    id: str
    duration_s: float
    size: int = 0
    mtime_ns: int = 0
    sha256: str = ""
    text: str | None = None
    animation: str | None = None

    @property
    def file(self) -> str:
        """Path of the clip's file below the indexed folder."""
        return self.id if self.animation is None else self.id.removesuffix(f"#{self.animation}")

    @property
    def is_file(self) -> bool:
        """Whether the clip came from a file."""
        return bool(self.sha256)


@dataclass(frozen=True)
class Caption:
    """Words that a library carries about a clip, or about a part of it.

    Attributes:
        clip: the clip's id.
        text: a caption, or words that people search for.
        start_s, end_s: the part that it is about, seconds; the whole clip without them.
        tags: words to filter by.
    """

    clip: str
    text: str
    start_s: float | None = None
    end_s: float | None = None
    tags: tuple[str, ...] = ()


@dataclass(frozen=True)
class Skipped:
    """A file that could not be indexed, and why."""

    path: str
    reason: str


@dataclass(frozen=True)
class Reading:
    """How the files of a library are read, where they do not say it themselves, or say it wrongly.

    Attributes:
        mapping: ``smpl24`` joint name -> joint name in the files.
        fps: frames per second of all files.
        up: their vertical axis, ``"y"`` or ``"z"``.
        asf: the skeleton of all ``.amc``, a path below the indexed folder.
        animation: the one to read of files that hold several; otherwise each is a clip of its own.
    """

    mapping: Mapping[str, str] | None = None
    fps: float | None = None
    up: str | None = None
    asf: str | None = None
    animation: str | None = None

    def arguments(self, source: Path, animation: str | None = None) -> dict[str, Any]:
        """What :func:`motionrt.load_motion` is to be called with, for a file of the folder ``source``."""
        asf = None if self.asf is None else source / self.asf
        chosen = self.animation if animation is None else animation
        return {"mapping": self.mapping, "fps": self.fps, "up": self.up, "asf": asf, "animation": chosen}


AS_THEY_ARE = Reading()
"""Files say all themselves."""


@dataclass(frozen=True)
class ModelStamp:
    """The model that made a gallery: its name for people and the checksum that counts."""

    name: str
    fingerprint: str


def window_table(spans: list[list[tuple[float, float]]]) -> WindowTable:
    """The table of windows: for every clip its spans in seconds."""
    rows = [(clip, start, end) for clip, parts in enumerate(spans) for start, end in parts]
    return np.array(rows, dtype=WINDOW_TYPE)
