"""What a store of motion has to do, in a few calls; everything else is done with what they give."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Filter, Gallery
from motionrt.retrieval.records import ModelStamp


@dataclass(frozen=True, eq=False)
class Nearest:
    """Windows that a store found, nearest first.

    Attributes:
        clips: ``n`` ids of their clips.
        spans: ``(n, 2)`` start and end in the clip, seconds.
        embeddings: ``(n, 256)`` float32, as they were put in.
        attributes: ``(n, A)`` float32 (:data:`motionrt.motion.attributes.ATTRIBUTES`); None where there are none.
        texts: what each clip shows, where that is known.
    """

    clips: Sequence[str]
    spans: npt.NDArray[np.float64]
    embeddings: FloatArray
    attributes: FloatArray | None
    texts: Sequence[str | None]


@dataclass(frozen=True)
class KnownFile:
    """A file whose clips a store holds.

    Attributes:
        size: its bytes when it was indexed.
        mtime_ns: its modification time then, nanoseconds.
        clips: ids of its clips.
    """

    size: int
    mtime_ns: int
    clips: tuple[str, ...]

    @classmethod
    def grouped(cls, rows: Iterable[tuple[str, str, int, int]]) -> dict[str, KnownFile]:
        """By file, out of file, clip, size and time of every clip."""
        found: dict[str, KnownFile] = {}
        for file, clip, size, mtime_ns in rows:
            before = found[file].clips if file in found else ()
            found[file] = cls(int(size), int(mtime_ns), (*before, clip))
        return found


@runtime_checkable
class GalleryStore(Protocol):
    """A library of motion in a database. All calls may be repeated: they change nothing the second time."""

    @property
    def model(self) -> ModelStamp:
        """Which model made the embeddings."""

    def __len__(self) -> int:
        """How many windows it holds."""

    def known(self, files: Sequence[str]) -> dict[str, KnownFile]:
        """Of those files the ones that it has clips of, by path below the indexed folder."""

    def upsert(self, clips: Gallery) -> None:
        """Add the clips of a gallery, or put them in the place of those with the same ids.

        All of them are there when it returns; until then a search may find some of them.
        """

    def delete(self, ids: Iterable[str]) -> None:
        """Take clips out; those that are not there are gone already."""

    def nearest(
        self,
        queries: FloatArray,
        count: int,
        filter: Filter,  # noqa: A002
        *,
        approximate: bool = False,
    ) -> list[Nearest]:
        """For each query ``(Q, 256)`` the ``count`` windows with the largest products, of those that the filter passes.

        Args:
            queries: unit vectors.
            count: how many, or all there are.
            filter: conditions; the store may refuse what it cannot say by an InvalidInputError.
            approximate: an index may miss some; otherwise exact.
        """

    def close(self) -> None:
        """Let go of the database."""
