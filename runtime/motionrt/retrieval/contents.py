"""What a gallery holds, without what it does: the value that :mod:`~motionrt.retrieval.layout` reads and writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import store
from motionrt.retrieval.records import AS_THEY_ARE, Caption, Clip, ModelStamp, Reading, Skipped, WindowTable


@dataclass(frozen=True, eq=False)
class Contents:
    """The parts of a gallery; see :class:`motionrt.retrieval.Gallery` for each of them."""

    clips: tuple[Clip, ...]
    embeddings: FloatArray
    windows: WindowTable
    model: ModelStamp
    source: Path | None = None
    skipped: tuple[Skipped, ...] = ()
    reading: Reading = AS_THEY_ARE
    motions: MotionPack | Path | None = None
    folder: Path | None = None
    neighbours: Path | None = None
    attributes: FloatArray | None = None
    captions: tuple[Caption, ...] = ()
    words_file: Path | None = None

    @property
    def mapping(self) -> Mapping[str, str] | None:
        """The joint mapping that the files were read with, if any."""
        return self.reading.mapping

    @cached_property
    def pack(self) -> MotionPack | None:
        """The motions that the gallery carries, read when first needed."""
        if not isinstance(self.motions, Path):
            return self.motions
        if self.folder is not None:
            store.verify(self.folder, {"motions": self.motions.name})
        try:
            return MotionPack.read(self.motions)
        except FormatError as error:
            raise store.damaged(error.path, error.reason) from error
