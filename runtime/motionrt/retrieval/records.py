"""What a gallery remembers of its clips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

WINDOW_TYPE = np.dtype([("clip", "<i4"), ("start_s", "<f4"), ("end_s", "<f4")])
WindowTable = npt.NDArray[np.void]


@dataclass(frozen=True)
class Clip:
    """One motion of a gallery.

    Attributes:
        id: unique name; for a file its path below the indexed folder, with forward slashes.
        duration_s: length in seconds.
        size: bytes of the file, 0 without one.
        mtime_ns: modification time of the file, nanoseconds, 0 without one.
        sha256: checksum of the file, empty without one.
        text: what the clip shows, where that is known.
    """

    id: str
    duration_s: float
    size: int = 0
    mtime_ns: int = 0
    sha256: str = ""
    text: str | None = None

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
class ModelStamp:
    """The model that made a gallery: its name for people and the checksum that counts."""

    name: str
    fingerprint: str


def window_table(spans: list[list[tuple[float, float]]]) -> WindowTable:
    """The table of windows: for every clip its spans in seconds."""
    rows = [(clip, start, end) for clip, parts in enumerate(spans) for start, end in parts]
    return np.array(rows, dtype=WINDOW_TYPE)
