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
    from motionrt.retrieval.where import Condition


@dataclass(frozen=True)
class Filter:
    """Conditions that hits must fulfil, all of them.

    Attributes:
        where: on attributes of the window, as in ``"turn > 60 and speed < 1.5"``.
        min_s, max_s: on the duration of the clip, seconds.
        folder: the clip lies below this folder of the library, as in ``"walks/slow"``.
        tags: tags that the clip has in the library's captions.

    Raises:
        InvalidInputError: a condition that cannot be read, or durations that no clip has.
    """

    where: str | None = None
    min_s: float | None = None
    max_s: float | None = None
    folder: str | None = None
    tags: Sequence[str] = ()

    def __post_init__(self) -> None:
        if self.where is not None:
            _read(self.where)
        if self.min_s is not None and self.max_s is not None and not self.min_s <= self.max_s:
            raise InvalidInputError(f"no clip lasts at least {self.min_s:g} s and at most {self.max_s:g} s")

    def __bool__(self) -> bool:
        return any(part not in (None, (), []) for part in (self.where, self.min_s, self.max_s, self.folder, self.tags))

    def allowed(self, gallery: Gallery) -> npt.NDArray[np.bool_]:
        """``(W,)`` which windows of a gallery may be hits.

        Raises:
            GalleryError: ``where`` in a gallery that has no attributes yet; the message says how to update it.
        """
        clips = np.array([self._fits(clip.id, clip.duration_s, gallery) for clip in gallery.clips], dtype=bool)
        allowed: npt.NDArray[np.bool_] = clips[gallery.windows["clip"]]
        if self.where is None:
            return allowed
        if gallery.attributes is None:
            place = gallery.folder or "GALLERY"
            raise GalleryError(
                f'this gallery has no attributes yet; bring it up to date: motionrt gallery update "{place}"'
            )
        fits: npt.NDArray[np.bool_] = _read(self.where)(Columns(gallery.attributes))
        return np.logical_and(allowed, fits)

    def _fits(self, clip: str, duration_s: float, gallery: Gallery) -> bool:
        if (self.min_s is not None and duration_s < self.min_s) or (self.max_s is not None and duration_s > self.max_s):
            return False
        if self.folder is not None and not f"{clip}/".startswith(self.folder.strip("/") + "/"):
            return False
        wanted = {tag.lower() for tag in self.tags}
        return not wanted or wanted <= gallery.tags.get(clip, frozenset())


def _read(where: str) -> Condition:
    from motionrt.retrieval.where import condition  # Python's parser is slow to import, and seldom needed

    return condition(where)


EVERYTHING = Filter()
"""The filter that lets every window pass."""
