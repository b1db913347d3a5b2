"""Galleries on disk that grow, shrink and are tidied up, a segment at a time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.retrieval import layout
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.growth import settled, without
from motionrt.retrieval.locking import writing
from motionrt.retrieval.merging import merged
from motionrt.retrieval.segments import Segment
from motionrt.retrieval.vectors import checked_precision
from motionrt.untrusted.arguments import check_kind, listed
from motionrt.untrusted.words import shown


def append(folder: Path, other: Contents) -> None:
    """Add the clips of another gallery, whose ids are new, to the gallery of a folder.

    Raises:
        InvalidInputError: one of the ids is taken; or only one of the galleries carries its motions.
        GalleryError: another model made the embeddings, or the folder cannot be written.
    """
    check_kind(other, Contents, "other", "a Gallery")
    with writing(folder):
        old = layout.read(folder)
        if old.model.fingerprint != other.model.fingerprint:
            raise GalleryError(f"the clips were embedded by {other.model.name}, the gallery's by {old.model.name}")
        if (old.motions is None) != (other.motions is None):
            raise InvalidInputError("either both galleries carry their motions, or none")
        taken = next((clip.id for clip in other.clips if _holds(old, clip.id)), None)
        if taken is not None:
            raise InvalidInputError(f"the gallery has a clip {shown(taken)} already")
        layout.save(old, folder, settled([], old.segments, [replace(part, files={}) for part in other.segments]))


def delete(folder: Path, ids: Iterable[str]) -> None:
    """Take clips out of the gallery of a folder; their files stay where they are.

    Raises:
        InvalidInputError: there is no clip of that id, or none would be left.
        GalleryError: the folder cannot be written.
    """
    wanted = list(ids) if isinstance(ids, set | frozenset) else listed(ids, "ids", "texts")
    for name in wanted:
        check_kind(name, str, "each of ids", "a str")
    with writing(folder):
        old = layout.read(folder)
        unknown = next((name for name in wanted if not _holds(old, name)), None)
        if unknown is not None:
            raise InvalidInputError(f"no clip {shown(unknown)} in this gallery")
        if len(set(wanted)) >= len(old.clips):
            raise InvalidInputError("a gallery needs at least one clip")
        changed: list[Segment] = []
        unchanged: list[Segment] = []
        for part in old.segments:
            numbers = [number for name in set(wanted) if (number := part.clips.number(name)) is not None]
            if numbers:
                changed.append(without(part, np.array(sorted(numbers), np.int64)))
            else:
                unchanged.append(part)
        layout.save(old, folder, settled(changed, unchanged, []))


def compact(folder: Path, precision: str | None = None) -> None:
    """Write the gallery of a folder as one segment, without what was deleted, in the layout of today.

    Args:
        folder: of the gallery.
        precision: what embeddings are stored in from now on, by default what they are.

    Raises:
        InvalidInputError: no such precision.
        GalleryError: a file is damaged, or the folder cannot be written.
    """
    with writing(folder):
        old = layout.read(folder)
        stored = old.precision if precision is None else checked_precision(precision)
        simple = len(old.segments) == 1 and old.segments[0].kept_clips is None and layout.is_current(old)
        if not simple or stored != old.precision:
            layout.save(replace(old, precision=stored), folder, [merged(old.segments)])


def _holds(gallery: Contents, clip_id: str) -> bool:
    for part in gallery.segments:
        number = part.clips.number(clip_id)
        if number is not None and (part.kept_clips is None or number in part.kept_clips):
            return True
    return False
