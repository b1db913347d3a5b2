"""Exact cosine search, the same answer every time."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.engine import Providers, checked_providers
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.scores import IntArray, scores, top
from motionrt.retrieval.vectors import Stored, Vectors
from motionrt.untrusted.arguments import checked_whole
from motionrt.untrusted.words import shown

if TYPE_CHECKING:
    from motionrt.retrieval.coded_scan import CodedScan

CODED_FROM = 4_000  # below, the float32 scan is as fast
CODED_LATE_FROM = 20_000  # from here the copy takes more than 20 ms
SELECTIVE = 64  # where fewer than one in so many vectors may be found, those are compared alone

Mask = npt.NDArray[np.bool_]
_FOUND_IN = "_found_in"


class Sketches(Protocol):
    """What can draw a hit: a gallery."""

    def sketch(self, hit: Hit | str) -> str:
        """SVG of a hit, under its name."""


@dataclass(frozen=True, repr=False)
class Hit:
    """One answer to a query.

    Attributes:
        rank: 1 is best.
        score: what hits are ordered by: the cosine of text and motion, -1 to 1, and what attributes and words add.
        id: the clip's name in its gallery: its path below the indexed folder, with forward slashes.
        path: the clip's file; ``None`` when the gallery carries the motion itself.
        start_s: where the found span starts in the clip, seconds.
        end_s: where it ends.
        text: what the gallery knows the clip to show, if anything.
        cosine: the cosine alone, where the score has other parts.
        agreement: how well the measured attributes agree with the text, 0 to 1; ``None`` where neither says anything.
    """

    rank: int
    score: float
    id: str
    path: Path | None
    start_s: float
    end_s: float
    text: str | None = None
    cosine: float | None = None
    agreement: float | None = None

    def __repr__(self) -> str:
        text = f", {self.text!r}" if self.text else ""
        return f"Hit({self.rank}, {self.score:.3f}, {self.id!r}, {self.start_s:.1f}-{self.end_s:.1f} s{text})"

    def found_in(self, gallery: Sketches) -> Hit:
        """The hit, which knows from now on where it was found, so that notebooks can draw it; copies do not."""
        object.__setattr__(self, _FOUND_IN, gallery)
        return self

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in vars(self).items() if name != _FOUND_IN}

    def _repr_html_(self) -> str:
        """A row with what is known of it, and a strip of poses where its gallery has the motion, for notebooks."""
        from motionrt.motion.notebook import page, table

        facts = [
            f"{self.rank}",
            f"{self.score:.3f}",
            f"{self.start_s:.1f}-{self.end_s:.1f} s",
            self.id,
            self.text or "",
        ]
        gallery: Sketches | None = getattr(self, _FOUND_IN, None)
        drawn = [] if gallery is None else [gallery.sketch(self)]
        return page("", table(("rank", "score", "span", "clip", "text"), [facts]), *drawn)


class VectorIndex(Protocol):
    """A set of unit vectors that can be asked for the nearest; the place for other kinds of scan."""

    def __len__(self) -> int: ...

    def prepare(self) -> None:
        """Get ready for many queries now."""

    def nearest(self, query: FloatArray, k: int, allowed: Mask | None = None) -> tuple[IntArray, FloatArray]:
        """Indices and scores of the ``min(k, N)`` vectors nearest to ``query`` ``(d,)``, best first.

        ``allowed`` ``(N,)`` says which may be found, by default all.
        """


class ExactIndex:
    """The answer of comparing every vector in float32; equal vectors stand in the order of their index.

    A large index copies itself into 8 or 4 bits (:mod:`~motionrt.retrieval.coded_scan`) when it is asked again: then
    the scan is 3 to 15 times as fast, the more the larger it is, and the answer the same to the last bit. But the copy
    takes as long as some forty float32 scans. So it is made at the second query where that is a matter of
    milliseconds, and from 20,000 vectors on after 32; :meth:`prepare` makes it at once. A question for a large part of
    the vectors (more than one in 16, or 4,096), or one that the copy cannot narrow down to a quarter of them, is
    answered in float32 alone. From 200,000 vectors on a scan takes two threads, where there are two cores. May be used
    from several threads.

    Args:
        vectors: ``(N, d)`` float32, kept, not copied, when its rows are contiguous; memory-mapped ones and those that
            are stored in fewer bits (:mod:`~motionrt.retrieval.vectors`), too.
        providers: onnxruntime's execution providers of the 8-bit scan, by default the CPU.
    """

    def __init__(self, vectors: Vectors, *, providers: Providers | None = None) -> None:
        self._vectors = vectors if isinstance(vectors, Stored) else np.ascontiguousarray(vectors, dtype=np.float32)
        self._providers = checked_providers(providers)
        self._asked = 0
        self._coded: CodedScan | None = None
        self._worth_coding = len(self._vectors) >= CODED_FROM
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._vectors)

    def __reduce__(self) -> tuple[Any, tuple[Vectors]]:
        return partial(ExactIndex, providers=self._providers), (
            self._vectors,
        )  # copied and pickled without what it made for itself

    def prepare(self) -> None:
        """Make the 8-bit copy now, so that no query waits for it; does nothing for a small index."""
        with self._lock:
            if self._worth_coding and self._coded is None:
                from motionrt.retrieval.coded_scan import CodedScan

                self._coded = CodedScan.build(self._vectors, self._providers)
                self._worth_coding = self._coded is not None

    def nearest(self, query: FloatArray, k: int, allowed: Mask | None = None) -> tuple[IntArray, FloatArray]:
        """See :class:`VectorIndex`.

        Raises:
            InvalidInputError: the query, or a vector, is not finite, or their products are beyond float32.
        """
        query = np.ascontiguousarray(query, dtype=np.float32)
        if not np.isfinite(query).all():
            raise InvalidInputError("the query is not finite: it has infinite numbers or NaN in it")
        self._asked += 1
        if self._worth_coding and self._asked > _patience(len(self)):
            self.prepare()
        found = self._candidates(query, k, allowed)
        if found is None:
            return top(self._checked(scores(self._vectors, query)), k)
        best, values = top(self._checked(scores(self._vectors[found], query), found), k)
        return found[best], values

    def _candidates(self, query: FloatArray, k: int, allowed: Mask | None) -> IntArray | None:
        """Ascending indices, with the k best allowed among them; None for all vectors."""
        if allowed is None:
            return self._coded.candidates(query, k) if self._coded is not None else None
        count = int(np.count_nonzero(allowed))
        if self._coded is not None and count * SELECTIVE > len(self):
            found = self._coded.candidates(query, min(k, count), allowed)
            if found is not None:
                return found
        return np.flatnonzero(allowed)

    def _checked(self, values: FloatArray, numbers: IntArray | None = None) -> FloatArray:
        if not np.isfinite(values).all():
            first = int(np.flatnonzero(~np.isfinite(values))[0])
            first = first if numbers is None else int(numbers[first])
            raise InvalidInputError(f"vector {first} is not finite, or too large to be compared in float32")
        return values


def _patience(count: int) -> int:
    """Queries that an index of ``count`` vectors answers before it is coded."""
    return 1 if count < CODED_LATE_FROM else 32


def nearest_per_group(
    index: VectorIndex, query: FloatArray, k: int, group: npt.NDArray[np.integer], allowed: Mask | None = None
) -> tuple[IntArray, FloatArray]:
    """As :meth:`VectorIndex.nearest`, but only the best of every group; ``group`` ``(N,)`` numbers them."""
    asked = k
    while True:
        found, scores = index.nearest(query, asked, allowed)
        _, first = np.unique(group[found], return_index=True)
        if len(first) >= k or asked >= len(index):
            kept = np.sort(first)[:k]
            return found[kept], scores[kept]
        asked *= 4


def checked_k(k: int) -> int:
    """``k`` as a whole number of at least 1; InvalidInputError otherwise."""
    value = checked_whole(k, "k")
    if value < 1:
        raise InvalidInputError(f"k must be at least 1, not {shown(k)}")
    return value
