"""What one machine of many does: some files of a library, indexed into a store."""

from __future__ import annotations

import pickle
import threading
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from motionrt.engines.objects import fetched
from motionrt.engines.opening import open_store
from motionrt.engines.store import GalleryStore
from motionrt.formats.folder import Stamp
from motionrt.retrieval import Gallery
from motionrt.retrieval.indexing import FileJob, IndexedClip, IndexedFile, OpenModel, index_file
from motionrt.retrieval.records import ModelStamp, Reading, Skipped, window_table
from motionrt.retrieval.windows import MotionEmbedder

_models: dict[bytes, MotionEmbedder] = {}  # of this process
_opening = threading.Lock()


@dataclass(frozen=True)
class Batch:
    """Files to index, and all that is needed for it; it can be pickled.

    Attributes:
        url: the library's folder, as fsspec takes it.
        files: paths below it, with their sizes and times.
        reading: how they are read.
        open_model: opens the motion model; a process opens it once.
        address: of the store that the clips go into.
    """

    url: str
    files: tuple[tuple[str, Stamp], ...]
    reading: Reading
    open_model: OpenModel
    address: str

    def single(self) -> list[Batch]:
        """The same files, each alone."""
        return [replace(self, files=(file,)) for file in self.files]


@dataclass(frozen=True)
class Done:
    """What became of a batch: how many clips and windows it gave, and what could not be read."""

    clips: int = 0
    windows: int = 0
    failures: tuple[Skipped, ...] = ()


def index_batch(batch: Batch) -> Done:
    """Read and embed the files, and put their clips into the store; done twice, it changes nothing.

    Raises:
        EngineError: the store cannot be reached, or refuses.
        OSError: the files' store cannot be read.
    """
    model = _model(batch.open_model)
    stamps = dict(batch.files)
    with fetched(batch.url, list(stamps), batch.reading.asf) as folder:
        outcomes = [index_file(FileJob(folder, name, batch.reading), model) for name in stamps]
    found = [outcome for outcome in outcomes if isinstance(outcome, IndexedFile)]
    clips = sorted((clip for one in found for clip in one.clips), key=lambda item: item.clip.id)
    failures = tuple(failure for one in found for failure in one.skipped)
    if not clips:
        return Done(failures=failures)
    gallery = _gallery(clips, stamps, ModelStamp(model.name, model.fingerprint))
    store = open_store(batch.address)
    try:
        _put(gallery, store, list(stamps))
    finally:
        store.close()
    return Done(len(gallery), len(gallery.windows), failures)


def _put(gallery: Gallery, store: GalleryStore, files: Sequence[str]) -> None:
    """Put clips into the store in place of all that it has of their files."""
    before = {clip for known in store.known(files).values() for clip in known.clips}
    store.upsert(gallery)
    if gone := before - {clip.id for clip in gallery.clips}:
        store.delete(sorted(gone))


def _gallery(clips: Sequence[IndexedClip], stamps: dict[str, Stamp], model: ModelStamp) -> Gallery:
    """The clips, with the sizes and times that their files have in the library."""
    told = [(item.clip, stamps[item.clip.file]) for item in clips]
    return Gallery(
        tuple(replace(clip, size=size, mtime_ns=time) for clip, (size, time) in told),
        np.concatenate([item.embeddings for item in clips]).astype(np.float32, copy=False),
        window_table([item.spans for item in clips]),
        model,
        attributes=np.concatenate([item.attributes for item in clips if item.attributes is not None]),
    )


def _model(open_model: OpenModel) -> MotionEmbedder:
    key = pickle.dumps(open_model)
    with _opening:
        if key not in _models:
            _models[key] = open_model()
        return _models[key]
