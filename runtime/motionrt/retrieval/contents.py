"""What a gallery holds, without what it does: the value that :mod:`~motionrt.retrieval.layout` reads and writes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from motionrt.formats.motion_pack import MotionPack
from motionrt.retrieval import segments as parts
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.records import AS_THEY_ARE, Caption, Clip, ModelStamp, Reading, Skipped, WindowTable
from motionrt.retrieval.segments import Segment
from motionrt.retrieval.vectors import Vectors


@dataclass(frozen=True, eq=False)
class Contents:
    """The parts of a gallery; see :class:`motionrt.retrieval.Gallery` for each of them."""

    clips: Sequence[Clip]
    embeddings: Vectors
    windows: WindowTable
    model: ModelStamp
    source: Path | None = None
    skipped: tuple[Skipped, ...] = ()
    reading: Reading = AS_THEY_ARE
    motions: MotionPack | Path | None = None
    folder: Path | None = None
    neighbours: Path | None = None
    attributes: Vectors | None = None
    captions: Sequence[Caption] = ()
    precision: str = "float32"
    sidecars: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    stored: tuple[Segment, ...] = ()

    @property
    def mapping(self) -> Mapping[str, str] | None:
        """The joint mapping that the files were read with, if any."""
        return self.reading.mapping

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The segments that it was read from; of a gallery in memory one."""
        return self.stored or (self._whole(),)

    @cached_property
    def pack(self) -> MotionPack | parts.Motions | None:
        """The motions that the gallery carries, read when first needed."""
        if self.stored:
            return parts.Motions(self.stored) if all(part.pack is not None for part in self.stored) else None
        return None if isinstance(self.motions, Path) else self.motions

    def _whole(self) -> Segment:
        clips = ClipTable.of(self.clips)
        return Segment(
            clips, self.windows, self.embeddings, self.attributes, CaptionTable.of(self.captions, clips.ids.texts()),
            self.motions, neighbours=self.neighbours,
        )  # fmt: skip
