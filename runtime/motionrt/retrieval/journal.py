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
from motionrt.retrieval.indexing import IndexedClip
from motionrt.retrieval.records import window_table
from motionrt.retrieval.segments import Segment

FOLDER = ".building"
EVERY_S, GROWTH = 10.0, 0.05  # seconds between two writes: at least, and of the time that the build has taken


@dataclass
class Journal:
    """What is kept of a build that goes on.

    Attributes:
        folder: where it is.
        facts: the model, the source and the mapping, which have to be the same.
        left: what a build that was killed has left.
        written: what was written since.
        fresh: what was indexed since then.
    """

    folder: Path
    facts: Contents
    left: Sequence[Segment] = ()
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
        if (found.model, found.source, found.mapping) == (facts.model, facts.source, facts.mapping):
            made.left = found.segments
        return made

    def add(self, clip: IndexedClip) -> None:
        """Note a clip that was indexed, and write it some time soon."""
        self.fresh.append(clip)
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
        layout.save(self.facts, self.folder, [*self.left, *self.written, segment_of(self.fresh)])
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
