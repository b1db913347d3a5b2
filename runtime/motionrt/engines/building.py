"""A library of files indexed into a store, on this machine or on many."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from motionrt.engines.batches import Batch, Done, index_batch
from motionrt.engines.dask import check_scheduler, on_dask
from motionrt.engines.objects import find_objects
from motionrt.engines.opening import open_store
from motionrt.engines.store import GalleryStore
from motionrt.errors import GalleryError
from motionrt.formats.folder import Stamp
from motionrt.retrieval.indexing import OpenModel
from motionrt.retrieval.records import AS_THEY_ARE, ModelStamp, Reading, Skipped

AT_ONCE = 1000  # files that a store is asked about


@dataclass(frozen=True)
class IndexReport:
    """What was done.

    Attributes:
        files: how many motion files the library has.
        unchanged: how many of them were in the store already, of the same size and time.
        clips, windows: how many were read, embedded and put into the store now.
        failures: files and animations that could not be read, and why.
        seconds: how long it took.
    """

    files: int
    unchanged: int
    clips: int
    windows: int
    failures: tuple[Skipped, ...]
    seconds: float

    @property
    def clips_per_s(self) -> float:
        """Clips that were read and embedded in a second, by all machines together."""
        return self.clips / self.seconds if self.seconds else 0.0


def index_into(
    url: str,
    address: str,
    open_model: OpenModel,
    *,
    on: str | None = None,
    reading: Reading = AS_THEY_ARE,
    batch: int = 32,
    progress: Callable[[int, int, str], None] | None = None,
) -> IndexReport:
    """Index every motion file below a folder into a store. Broken off, or done again, it does what is left to do.

    Files whose size and time are in the store are not read. Clips of files that are gone stay in the store until
    somebody deletes them.

    Args:
        url: a folder, or the address of one as fsspec takes it (``s3://bucket/library``); all workers must reach it.
        address: of the store (:func:`open_store`); it is made where it is not there yet.
        open_model: opens the motion model; must survive pickling.
        on: a Dask scheduler, ``dask://host:8786``; None works here.
        reading: how the files are read.
        batch: files of one task.
        progress: called with files done, files to do and a file's name.

    Raises:
        MotionFileNotFoundError, InvalidInputError: no such folder, no motion file there, or no such kind of address.
        GalleryError: another model made the store's embeddings.
        EngineError: the store or the scheduler cannot be reached.
        MissingDependencyError: the extra ``cluster``, or the store's, is not installed.
    """
    began = time.perf_counter()
    if on is not None:
        check_scheduler(on)
    files, model = find_objects(url), open_model()
    stamp = ModelStamp(model.name, model.fingerprint)
    store = open_store(address, stamp)
    try:
        if store.model.fingerprint != stamp.fingerprint:
            raise GalleryError(f"the store's clips were embedded by {store.model.name}, not by {stamp.name}")
        due = list(_due(files, store))
    finally:
        store.close()
    batches = [
        Batch(url, tuple(due[first : first + batch]), reading, open_model, address)
        for first in range(0, len(due), batch)
    ]
    ready, done = 0, []
    for one, outcome in _run(batches, on):
        ready += len(one.files)
        done.append(outcome)
        if progress is not None:
            progress(ready, len(due), one.files[-1][0])
    return _report(files, due, done, time.perf_counter() - began)


def _due(files: Mapping[str, Stamp], store: GalleryStore) -> Iterator[tuple[str, Stamp]]:
    """The files that are not in the store as they are."""
    names = list(files)
    for first in range(0, len(names), AT_ONCE):
        part = names[first : first + AT_ONCE]
        known = store.known(part)
        for name in part:
            if name not in known or (known[name].size, known[name].mtime_ns) != files[name]:
                yield name, files[name]


def _run(batches: Sequence[Batch], on: str | None) -> Iterator[tuple[Batch, Done]]:
    if on is None:
        return ((batch, index_batch(batch)) for batch in batches)
    return on_dask(on, batches)


def _report(
    files: Mapping[str, Stamp], due: Sequence[tuple[str, Stamp]], done: Sequence[Done], seconds: float
) -> IndexReport:
    failures = sorted((failure for one in done for failure in one.failures), key=lambda item: item.path)
    clips, windows = (sum(getattr(one, name) for one in done) for name in ("clips", "windows"))
    return IndexReport(len(files), len(files) - len(due), clips, windows, tuple(failures), seconds)
