"""Hits and moments as files: the original rig, cut to the span that was found."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.motion import Motion
from motionrt.untrusted.files import as_path
from motionrt.untrusted.names import plain_stem

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery
    from motionrt.retrieval.moments import Moment
    from motionrt.retrieval.search import Hit

_SUFFIX = re.compile(r"\.(bvh|amc|npz|glb|gltf)$", re.IGNORECASE)


@dataclass(frozen=True)
class Saved:
    """A file that was written, and what it holds, in words."""

    path: Path
    what: str


def save_hits(gallery: Gallery, hits: Sequence[Hit], folder: str | Path) -> list[Saved]:
    """Write every hit into a folder: a ``.bvh``, ``.amc`` or ``.npz`` cut as it is, a ``.glb`` with its own character.

    A motion that the gallery itself carries becomes a ``.bvh`` of the ``smpl24`` skeleton.

    Raises:
        InvalidInputError: the folder cannot be made.
        MotionFileNotFoundError, FormatError: a clip's file is gone, or broken now.
    """
    out = _made(folder)
    return [_saved(gallery.motion(hit.id), hit.path, _Span.of(hit, hit.id), out) for hit in hits]


def save_moments(source: str | Path, motion: Motion, moments: Sequence[Moment], folder: str | Path) -> list[Saved]:
    """Write every moment of a motion into a folder, as :func:`save_hits` writes hits.

    Args:
        source: the file that ``motion`` was read from.
        motion: all of it.
        moments: what is to be written.
        folder: where; it is made if there is none.

    Raises:
        InvalidInputError: the folder cannot be made.
        MotionFileNotFoundError, FormatError: the file is gone, or broken now.
    """
    out, source = _made(folder), as_path(source)
    return [_saved(motion, source, _Span.of(moment, source.name), out) for moment in moments]


@dataclass(frozen=True)
class _Span:
    """A part of a clip, seconds."""

    rank: int
    clip: str
    start: float
    end: float

    @staticmethod
    def of(found: Hit | Moment, clip: str) -> _Span:
        return _Span(found.rank, clip, found.start_s, found.end_s)

    @property
    def file_name(self) -> str:
        """Rank, clip and span, in letters that every file system takes."""
        stem = _SUFFIX.sub("", self.clip)
        plain = plain_stem(stem.replace("/", "__"), 150)
        return f"{self.rank:03d}_{plain}_{self.start:.1f}-{self.end:.1f}s"


def _made(folder: str | Path) -> Path:
    out = as_path(folder)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(f"cannot make the folder {out}: {error.strerror}") from error
    return out


def _saved(whole: Motion, source: Path | None, span: _Span, folder: Path) -> Saved:
    from motionrt.formats.cutting import can_cut, cut_file

    name = span.file_name
    if source is None:
        return _plain(whole, span, folder / f"{name}.bvh", "smpl24")
    if can_cut(source):
        first = min(round(span.start * whole.fps), whole.frames - 1)
        stop = min(max(round(span.end * whole.fps), first + 1), whole.frames)
        path = cut_file(
            source, folder / f"{name}{source.suffix.lower()}", first, stop, frames=whole.frames, fps=whole.fps
        )
        return Saved(path, f"frames {first} to {stop - 1} of {span.clip}, as they are")
    try:
        path = whole.between(span.start, span.end).retarget_to(source).save(folder / f"{name}.glb")
    except MotionRTError:
        return _plain(whole, span, folder / f"{name}.bvh", "smpl24: its own character cannot be written")
    return Saved(path, f"{span.start:.1f} to {span.end:.1f} s of {span.clip}, on its own character")


def _plain(whole: Motion, span: _Span, path: Path, skeleton: str) -> Saved:
    whole.between(span.start, span.end).save(path)
    return Saved(path, f"{span.start:.1f} to {span.end:.1f} s of {span.clip}, on the skeleton {skeleton}")
