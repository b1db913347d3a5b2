"""Which windows a search may answer with: by attributes, duration, folder and tags."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.retrieval.columns import Columns

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery
    from motionrt.retrieval.segments import Segment
    from motionrt.retrieval.where import Condition


@dataclass(frozen=True)
class Filter:
    """Conditions that hits must fulfil, all of them.

    Attributes:
        where: on attributes of the window, as in ``"turn > 60 and speed < 1.5"``.
        min_s, max_s: on the duration of the clip, seconds.
        folder: the clip lies below this folder of the library, as in ``"walks/slow"``.
        tags: tags that the clip has in the library's captions.
        text: words that captions, tags or file names of the window have, all of them, whatever their endings.

    Raises:
        InvalidInputError: a condition that cannot be read, or durations that no clip has.
    """

    where: str | None = None
    min_s: float | None = None
    max_s: float | None = None
    folder: str | None = None
    tags: Sequence[str] = ()
    text: str | None = None

    def __post_init__(self) -> None:
        if self.where is not None:
            _read(self.where)
        if self.min_s is not None and self.max_s is not None and not self.min_s <= self.max_s:
            raise InvalidInputError(f"no clip lasts at least {self.min_s:g} s and at most {self.max_s:g} s")

    def __bool__(self) -> bool:
        parts = (self.where, self.min_s, self.max_s, self.folder, self.tags, self.text)
        return any(part not in (None, (), []) for part in parts)

    def allowed(self, gallery: Gallery) -> npt.NDArray[np.bool_]:
        """``(W,)`` which windows of a gallery may be hits.

        Raises:
            GalleryError: ``where`` in a gallery that has no attributes yet; the message says how to update it.
        """
        allowed: npt.NDArray[np.bool_] = np.concatenate([self._fits(part) for part in gallery.segments])
        if self.text is not None:
            allowed &= gallery.words.having(self.text)
        if self.where is None:
            return allowed
        if gallery.attributes is None:
            place = gallery.folder or "GALLERY"
            raise GalleryError(
                f'this gallery has no attributes yet; bring it up to date: motionrt gallery update "{place}"'
            )
        fits: npt.NDArray[np.bool_] = _read(self.where)(Columns(gallery.attributes))
        return np.logical_and(allowed, fits)

    def _fits(self, part: Segment) -> npt.NDArray[np.bool_]:
        """Which windows of a segment, of those that count, are of clips that fit."""
        clips = np.ones(len(part.clips), dtype=bool)
        if self.min_s is not None:
            clips &= part.clips.duration_s >= self.min_s
        if self.max_s is not None:
            clips &= part.clips.duration_s <= self.max_s
        if self.folder is not None:
            clips &= part.clips.below(self.folder)
        for tag in self.tags:
            clips &= part.captions.tagged_with(tag, len(clips))
        owners = part.windows["clip"]
        found: npt.NDArray[np.bool_] = clips[owners if part.kept_windows is None else owners[part.kept_windows]]
        return found


def _read(where: str) -> Condition:
    from motionrt.retrieval.where import condition  # Python's parser is slow to import, and seldom needed

    return condition(where)


EVERYTHING = Filter()
"""The filter that lets every window pass."""
