"""Hits as files: the original rig, cut to the span that was found."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.motion import Motion
from motionrt.untrusted.files import as_path

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery
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
    out = as_path(folder)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(f"cannot make the folder {out}: {error.strerror}") from error
    return [_saved(gallery, hit, out) for hit in hits]


def _saved(gallery: Gallery, hit: Hit, folder: Path) -> Saved:
    from motionrt.formats.cutting import can_cut, cut_file

    whole = gallery.motion(hit.id)
    source, name = hit.path, _file_name(hit)
    if source is None:
        return _plain(whole, hit, folder / f"{name}.bvh", "smpl24")
    if can_cut(source):
        first = min(round(hit.start_s * whole.fps), whole.frames - 1)
        stop = min(max(round(hit.end_s * whole.fps), first + 1), whole.frames)
        path = cut_file(
            source, folder / f"{name}{source.suffix.lower()}", first, stop, frames=whole.frames, fps=whole.fps
        )
        return Saved(path, f"frames {first} to {stop - 1} of {hit.id}, as they are")
    try:
        path = whole.between(hit.start_s, hit.end_s).retarget_to(source).save(folder / f"{name}.glb")
    except MotionRTError:
        return _plain(whole, hit, folder / f"{name}.bvh", "smpl24: its own character cannot be written")
    return Saved(path, f"{hit.start_s:.1f} to {hit.end_s:.1f} s of {hit.id}, on its own character")


def _plain(whole: Motion, hit: Hit, path: Path, skeleton: str) -> Saved:
    whole.between(hit.start_s, hit.end_s).save(path)
    return Saved(path, f"{hit.start_s:.1f} to {hit.end_s:.1f} s of {hit.id}, on the skeleton {skeleton}")


def _file_name(hit: Hit) -> str:
    """Rank, clip and span, in letters that every file system takes."""
    stem = _SUFFIX.sub("", hit.id)
    plain = re.sub(r"[^\w.-]+", "_", stem.replace("/", "__")).encode()[:150].decode(errors="ignore")
    return f"{hit.rank:03d}_{plain}_{hit.start_s:.1f}-{hit.end_s:.1f}s"
