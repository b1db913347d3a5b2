"""A segment: clips that were written at once, with all that a gallery keeps of them; galleries are made of segments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import Motion
from motionrt.retrieval import store
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.records import WINDOW_TYPE, Caption, Clip, WindowTable
from motionrt.retrieval.sequences import Chain, Lazy
from motionrt.retrieval.vectors import Block, Blocks, Vectors
from motionrt.retrieval.words import Postings, WordIndex

Numbers = npt.NDArray[np.integer[Any]]

CHECKED_AT_OPEN, CHECKED_AT_SEARCH = 1 << 20, 256 << 20  # bytes of a file, up to which it is checked then


@dataclass(frozen=True, eq=False)
class Segment:
    """Clips and their windows; the numbers of both count within the segment.

    Attributes:
        clips: ``N`` clips.
        windows: ``(W,)`` records of clip number, ``start_s`` and ``end_s``, in the order of the clips.
        vectors: ``(W, 256)`` embeddings.
        attributes: ``(W, A)`` float32, None in a gallery of an older motionrt.
        captions: what the library says of the clips.
        motions: the clips themselves, or the file that holds them, if the gallery carries them.
        deleted: ascending numbers of clips that no longer count.
        folder: where its files are, None in memory.
        files: their names by role.
        neighbours: where the graph of its vectors for approximate search is kept, if anywhere.
        postings: the words of its windows, where they are known already.
    """

    clips: ClipTable
    windows: WindowTable
    vectors: Vectors
    attributes: Vectors | None
    captions: CaptionTable
    motions: MotionPack | Path | None = None
    deleted: Numbers = field(default_factory=lambda: np.zeros(0, np.uint32))
    folder: Path | None = None
    files: Mapping[str, str] = field(default_factory=dict)
    neighbours: Path | None = None
    postings: Postings | None = None

    @cached_property
    def kept_clips(self) -> Numbers | None:
        """Ascending numbers of the clips that count; None for all."""
        if not len(self.deleted):
            return None
        return np.flatnonzero(self._keeps)

    @cached_property
    def kept_windows(self) -> Numbers | None:
        """Ascending numbers of the windows that count; None for all."""
        if not len(self.deleted):
            return None
        return np.flatnonzero(self._keeps[self.windows["clip"]])

    @cached_property
    def _keeps(self) -> npt.NDArray[np.bool_]:
        keeps = np.ones(len(self.clips), dtype=bool)
        keeps[self.deleted] = False
        return keeps

    @property
    def clip_count(self) -> int:
        """How many clips count."""
        return len(self.clips) - len(self.deleted)

    @property
    def window_count(self) -> int:
        """How many windows count."""
        return len(self.windows) if self.kept_windows is None else len(self.kept_windows)

    @cached_property
    def words(self) -> Postings:
        """The words of the windows that count."""
        found = self.postings or Postings.of(self.clips, self.windows, self.captions)
        return found if self.kept_windows is None else found.among(self.kept_windows)

    @cached_property
    def pack(self) -> MotionPack | None:
        """The motions of all its clips, read when first needed."""
        if not isinstance(self.motions, Path):
            return self.motions
        self.check(None, "motions")
        try:
            return MotionPack.read(self.motions)
        except FormatError as error:
            raise store.damaged(error.path, error.reason) from error

    def check(self, most: int | None, *roles: str) -> None:
        """GalleryError if one of its files, of those up to ``most`` bytes, is damaged; a file is checked once.

        Args:
            most: bytes; None for all.
            roles: of the files, by default all but the motions.
        """
        if self.folder is None:
            return
        for role in roles or set(self.files) - {"motions"}:
            name = self.files.get(role)
            if name is None or name in self._right:
                continue
            try:
                small = most is None or (self.folder / name).stat().st_size <= most
            except FileNotFoundError:  # another process has replaced the gallery: this one is mapped
                continue
            if small:
                store.verify(self.folder, {role: name})
                self._right.add(name)

    @cached_property
    def _right(self) -> set[str]:
        return set()


class Motions(Lazy[Motion]):
    """The motions that the segments of a gallery carry, in the order of its clips."""

    def __init__(self, segments: Sequence[Segment]) -> None:
        self._segments = segments
        self._ends = np.cumsum([segment.clip_count for segment in segments])

    def __len__(self) -> int:
        return int(self._ends[-1])

    def _item(self, index: int) -> Motion:
        number = int(np.searchsorted(self._ends, index, side="right"))
        segment = self._segments[number]
        place = index - (int(self._ends[number - 1]) if number else 0)
        assert segment.pack is not None
        return segment.pack[place if segment.kept_clips is None else int(segment.kept_clips[place])]


def clips_of(segments: Sequence[Segment]) -> Sequence[Clip]:
    """The clips of a gallery."""
    if _simple(segments):
        return segments[0].clips
    return Chain([(segment.clips, segment.kept_clips) for segment in segments])


def captions_of(segments: Sequence[Segment]) -> Sequence[Caption]:
    """What the library says of them."""
    if _simple(segments):
        return segments[0].captions if len(segments[0].captions) else ()
    parts = []
    for segment in segments:
        gone = np.isin(segment.captions.clip, segment.deleted)
        parts.append((segment.captions, np.flatnonzero(~gone)))
    return Chain(parts)


def windows_of(segments: Sequence[Segment]) -> WindowTable:
    """Their windows, with the numbers of the clips in the gallery."""
    if _simple(segments):
        return segments[0].windows
    parts, first = [], 0
    for segment in segments:
        kept = segment.windows if segment.kept_windows is None else segment.windows[segment.kept_windows]
        part = np.array(kept, dtype=WINDOW_TYPE)
        if segment.kept_clips is not None:
            part["clip"] = np.searchsorted(segment.kept_clips, part["clip"])
        part["clip"] += first
        first += segment.clip_count
        parts.append(part)
    return np.concatenate(parts)


def embeddings_of(segments: Sequence[Segment]) -> Vectors:
    """The embeddings of their windows."""
    if _simple(segments):
        return segments[0].vectors
    return Blocks([Block(part.vectors, part.kept_windows, part.neighbours) for part in segments])


def attributes_of(segments: Sequence[Segment]) -> Vectors | None:
    """The attributes of their windows; None if those of one are missing."""
    if _simple(segments):
        return segments[0].attributes
    tables = [segment.attributes for segment in segments]
    if any(table is None for table in tables):
        return None
    return Blocks([Block(t, s.kept_windows) for t, s in zip(tables, segments, strict=True) if t is not None])


def words_of(segments: Sequence[Segment]) -> WordIndex:
    """The words of all."""
    return WordIndex([segment.words for segment in segments])


def _simple(segments: Sequence[Segment]) -> bool:
    return len(segments) == 1 and not len(segments[0].deleted)
