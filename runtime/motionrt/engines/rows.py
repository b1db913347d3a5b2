"""The clips of a gallery as rows of a database, one a window."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Clip, Gallery
from motionrt.untrusted.words import shown


@dataclass(frozen=True, eq=False)
class Row:
    """A window of a clip.

    Attributes:
        clip: which.
        part: its number in the clip, from 0.
        start_s, end_s: its span, seconds.
        tags: of the clip, lower case.
        embedding: ``(256,)`` float32.
        attributes: ``(A,)`` float32, None where there are none.
    """

    clip: Clip
    part: int
    start_s: float
    end_s: float
    tags: tuple[str, ...]
    embedding: FloatArray
    attributes: FloatArray | None


def rows_of(gallery: Gallery) -> Iterator[Row]:
    """All windows, clip by clip.

    Raises:
        InvalidInputError: an id that no database takes: with control characters, or bytes that are no Unicode.
    """
    embeddings = np.asarray(gallery.embeddings)
    attributes = None if gallery.attributes is None else np.asarray(gallery.attributes)
    last, part = -1, 0
    for number, (clip, start, end) in enumerate(gallery.windows.tolist()):
        part = part + 1 if clip == last else 0
        last = clip
        told = gallery.clips[clip]
        if any(letter < " " or "\ud800" <= letter <= "\udfff" for letter in told.id):
            raise InvalidInputError(f"a database takes no clip called {shown(told.id)}: rename the file")
        tags = tuple(sorted(gallery.tags.get(told.id, ())))
        yield Row(told, part, start, end, tags, embeddings[number], None if attributes is None else attributes[number])
