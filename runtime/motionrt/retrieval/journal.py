"""What a build has indexed so far, kept in the gallery's folder: a build that is killed goes on where it was.

It is a gallery of its own, ``.building``, that grows by segments, and goes when the build has written its gallery.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from motionrt.errors import GalleryError, GalleryNotFoundError
from motionrt.retrieval import layout, store
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.indexing import IndexedClip, IndexedFile
from motionrt.retrieval.records import Skipped, window_table
from motionrt.retrieval.segments import Segment

FOLDER = ".building"
EVERY_S, GROWTH = 10.0, 0.05  # seconds between two writes: at least, and of the time that the build has taken


@dataclass
class Journal:
    """What is kept of a build that goes on.

    Attributes:
        folder: where it is.
        facts: the model, the source and how files are read, which have to be the same.
        left: what a build that was killed has left.
        skipped: what could not be read, by that build and by this one.
        written: what was written since.
        fresh: what was indexed since then.
    """

    folder: Path
    facts: Contents
    left: Sequence[Segment] = ()
    skipped: list[Skipped] = field(default_factory=list)
    written: list[Segment] = field(default_factory=list)
    fresh: list[IndexedClip] = field(default_factory=list)
    _began: float = field(default_factory=time.monotonic)
    _wrote: float = field(default_factory=time.monotonic)

    @classmethod
    def open(cls, target: Path, facts: Contents) -> Journal:
        """The journal in the folder of a gallery, with what a build of the same folder by the same model has left."""
        made = cls(target / FOLDER, replace(facts, precision="float32"))
        try:
            found = layout.read(store.locate(made.folder))
            for part in found.segments:
                part.check(None)
        except (GalleryNotFoundError, GalleryError):
            return made
        if (found.model, found.source, found.reading) == (facts.model, facts.source, facts.reading):
            made.left, made.skipped = found.segments, list(found.skipped)
        return made

    def add(self, file: IndexedFile) -> None:
        """Note a file that was indexed, and write its clips some time soon."""
        self.fresh += file.clips
        self.skipped += file.skipped
        if not self.fresh:
            return
        now = time.monotonic()
        if now - self._wrote >= max(EVERY_S, GROWTH * (now - self._began)):
            self._write()
            self._wrote = time.monotonic()

    def new(self) -> list[Segment]:
        """All that was indexed since it was opened."""
        return [*self.written, *([segment_of(self.fresh)] if self.fresh else [])]

    def close(self) -> None:
        """The build has written its gallery."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _write(self) -> None:
        self.folder.mkdir(exist_ok=True)
        facts = replace(self.facts, skipped=tuple(self.skipped))
        layout.save(facts, self.folder, [*self.left, *self.written, segment_of(self.fresh)])
        self.written = list(layout.read(self.folder).segments[len(self.left) :])
        self.fresh = []


def segment_of(indexed: Sequence[IndexedClip]) -> Segment:
    """Clips that were just indexed, as a segment in memory."""
    clips = ClipTable.of([item.clip for item in indexed])
    vectors = np.concatenate([item.embeddings for item in indexed]).astype(np.float32, copy=False)
    tables = [item.attributes for item in indexed if item.attributes is not None]
    attributes = np.concatenate(tables) if len(tables) == len(indexed) else None
    captions = CaptionTable.of((), clips.ids)
    return Segment(clips, window_table([item.spans for item in indexed]), vectors, attributes, captions)
