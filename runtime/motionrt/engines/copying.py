"""A gallery put into a store, some clips at a time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from motionrt.engines.store import GalleryStore
from motionrt.errors import GalleryError
from motionrt.retrieval import Caption, Gallery

AT_ONCE = 1000  # clips


def copy_gallery(gallery: Gallery, store: GalleryStore, progress: Callable[[int, int], None] | None = None) -> int:
    """Upsert all clips of a gallery; gives how many. Broken off, it may simply be called again.

    Args:
        gallery: whose clips.
        store: where to.
        progress: told how many of how many clips are there.

    Raises:
        GalleryError: the store holds embeddings of another model.
    """
    if store.model.fingerprint != gallery.model.fingerprint:
        raise GalleryError(f"the store's clips were embedded by {store.model.name}, these by {gallery.model.name}")
    bounds = np.searchsorted(gallery.windows["clip"], np.arange(len(gallery) + 1))
    for first in range(0, len(gallery), AT_ONCE):
        last = min(first + AT_ONCE, len(gallery))
        store.upsert(_part(gallery, first, last, slice(int(bounds[first]), int(bounds[last]))))
        if progress is not None:
            progress(last, len(gallery))
    return len(gallery)


def _part(gallery: Gallery, first: int, last: int, rows: slice) -> Gallery:
    windows = np.array(gallery.windows[rows])
    windows["clip"] -= first
    clips = tuple(gallery.clips[first:last])
    attributes = None if gallery.attributes is None else np.asarray(gallery.attributes[rows])
    tags = [Caption(clip.id, "", tags=tuple(gallery.tags[clip.id])) for clip in clips if clip.id in gallery.tags]
    embeddings = np.asarray(gallery.embeddings[rows])
    return Gallery(clips, embeddings, windows, gallery.model, attributes=attributes, captions=tuple(tags))
