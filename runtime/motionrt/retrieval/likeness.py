"""Motions that are like another one, and clips of a gallery that are the same."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.finding import Hits
from motionrt.retrieval.search import checked_k

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery

_SIDED = tuple(ATTRIBUTES.index(name) for name in ("turn", "path_bend", "walk_left", "arm_dominance", "leg_dominance"))
_SAME_SIDES = (25.0, 35.0, 0.4, 0.25, 0.25)  # how far apart those of two recordings of one motion may be
_BLOCK = 2048  # clips that are compared at once


@dataclass(frozen=True)
class Duplicates:
    """Clips that show the same motion.

    Attributes:
        ids: of the clips, at least two.
        identical: whether their files are equal to the byte.
        cosine: the least of two of them.
    """

    ids: tuple[str, ...]
    identical: bool
    cosine: float


def similar(gallery: Gallery, query: FloatArray, k: int = 10, *, without: str | None = None) -> Hits:
    """The clips most like an embedded motion ``(256,)``; ``without`` leaves out the clip of that id."""
    k = checked_k(k)
    hits = [hit for hit in gallery.search(query, k + 1) if hit.id != without][:k]
    return Hits((replace(hit, rank=rank) for rank, hit in enumerate(hits, 1)), gallery=gallery)


def duplicates(gallery: Gallery, cosine: float = 0.985) -> list[Duplicates]:
    """Groups of clips that show the same motion: equal files, or as long, embedded alike and to the same side.

    Args:
        gallery: looked through whole.
        cosine: of two clips that count as the same.
    """
    whole = _clip_vectors(gallery)
    pairs = [pair for first in range(0, len(whole), _BLOCK) for pair in _pairs(gallery, whole, first, cosine)]
    groups = _joined(len(whole), pairs)
    return [_told(gallery, whole, group) for group in groups]


def _clip_vectors(gallery: Gallery) -> FloatArray:
    """``(N, 256)`` mean of each clip's windows, normalised."""
    starts = np.searchsorted(gallery.windows["clip"], np.arange(len(gallery)))
    total = np.add.reduceat(np.asarray(gallery.embeddings), starts, axis=0)
    return np.asarray(total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12), dtype=np.float32)


def _pairs(gallery: Gallery, whole: FloatArray, first: int, cosine: float) -> list[tuple[int, int]]:
    block = whole[first : first + _BLOCK] @ whole.T
    one, other = np.nonzero(block >= cosine)
    one += first
    return [(int(i), int(j)) for i, j in zip(one, other, strict=True) if i < j and _same(gallery, int(i), int(j))]


def _same(gallery: Gallery, i: int, j: int) -> bool:
    one, other = gallery.clips[i], gallery.clips[j]
    if one.sha256 and one.sha256 == other.sha256:
        return True
    if abs(one.duration_s - other.duration_s) > 0.1 + 0.02 * max(one.duration_s, other.duration_s):
        return False
    if gallery.attributes is None:
        return True
    starts = np.searchsorted(gallery.windows["clip"], [i, j])
    apart = np.abs(np.subtract(*gallery.attributes[starts][:, _SIDED]))
    return bool((apart <= _SAME_SIDES).all())


def _joined(count: int, pairs: list[tuple[int, int]]) -> list[list[int]]:
    """Groups of clips that hang together by pairs, in order."""
    head = list(range(count))

    def top(k: int) -> int:
        while head[k] != k:
            head[k] = head[head[k]]
            k = head[k]
        return k

    for i, j in pairs:
        low, high = sorted((top(i), top(j)))
        head[high] = low
    groups: dict[int, list[int]] = {}
    for k in {k for pair in pairs for k in pair}:
        groups.setdefault(top(k), []).append(k)
    return [sorted(groups[k]) for k in sorted(groups)]


def _told(gallery: Gallery, whole: FloatArray, group: list[int]) -> Duplicates:
    sums = {gallery.clips[k].sha256 for k in group}
    cosines: npt.NDArray[np.float32] = whole[group] @ whole[group].T
    return Duplicates(
        tuple(gallery.clips[k].id for k in group), len(sums) == 1 and "" not in sums, float(cosines.min())
    )
