"""A search with everything: the nearest by embedding, and of those the best by measured attributes and words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.columns import Columns
from motionrt.retrieval.filters import EVERYTHING, Filter
from motionrt.retrieval.ranking import DEFAULT, Weights, combined
from motionrt.retrieval.scores import IntArray, scores
from motionrt.retrieval.search import Hit, checked_k
from motionrt.retrieval.vocabulary import unknown_words
from motionrt.text import agreements, parse_query
from motionrt.untrusted.arguments import check_flags, check_kind

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery

WIDE, TIMES = 200, 10  # windows that are looked at closely: at least, and for every hit that is wanted
_BY_WORDS = 100  # windows that their words bring in
_ALL = 10_000  # windows that pass a filter, up to which all are looked at closely


class Hits(list[Hit]):
    """Hits, best first, and what there is to say about them.

    Attributes:
        notice: in words, where the search could not do what was asked, else None.
        unknown_words: words of the text that neither motionrt nor the library knows.
        gallery: where they were found, which has their motions; None where nothing was.
    """

    def __init__(
        self,
        hits: Iterable[Hit] = (),
        notice: str | None = None,
        unknown_words: tuple[str, ...] = (),
        gallery: Gallery | None = None,
    ) -> None:
        super().__init__(hits if gallery is None else (hit.found_in(gallery) for hit in hits))
        self.notice = notice
        self.unknown_words = unknown_words
        self.gallery = gallery

    def _repr_html_(self) -> str:
        """A table with strips of the first hits, for notebooks."""
        from motionrt.motion.notebook import PICTURED, page, table

        rows = [[f"{h.rank}", f"{h.score:.3f}", f"{h.start_s:.1f}-{h.end_s:.1f} s", h.id, h.text or ""] for h in self]
        drawn = [] if self.gallery is None else [self.gallery.sketch(hit) for hit in self[:PICTURED]]
        return page(self.notice or "", table(("rank", "score", "span", "clip", "text"), rows), *drawn)


def grouped(hits: Iterable[Hit]) -> list[list[Hit]]:
    """Hits by clip: the clip with the best hit first, and of every clip its best first."""
    groups: dict[str, list[Hit]] = {}
    for hit in hits:
        groups.setdefault(hit.id, []).append(hit)
    return list(groups.values())


@dataclass(frozen=True)
class Search:
    """How to search.

    Attributes:
        k: how many hits.
        per_clip: only the best window of every clip.
        approximate: by the graph of neighbours, see :meth:`motionrt.retrieval.Gallery.search`.
        weights: what cosine, attributes and words count.
        filter: which windows may be hits.
        anyway: search by embedding even for a text of which no word is known.
    """

    k: int = 10
    per_clip: bool = True
    approximate: bool = False
    weights: Weights = DEFAULT
    filter: Filter = EVERYTHING
    anyway: bool = False

    def __post_init__(self) -> None:
        checked_k(self.k)
        check_flags(per_clip=self.per_clip, approximate=self.approximate, anyway=self.anyway)
        check_kind(self.weights, Weights, "weights", "a motionrt.retrieval.Weights")
        check_kind(self.filter, Filter, "filter", "a motionrt.retrieval.Filter")


def find(gallery: Gallery, text: str, query: FloatArray, search: Search) -> Hits:
    """The best hits for a text and its embedding ``(256,)``.

    The windows that are nearest by embedding, or share words with the text, are ranked by cosine, attributes and words
    together; in a gallery of up to 200 windows, and behind a filter that lets 10,000 or fewer pass, those are all.
    """
    k, weights = checked_k(search.k), search.weights
    unknown = unknown_words(text, gallery.words) if search.weights.words and not search.anyway else ()
    if unknown:
        asked = ", ".join(map(repr, unknown))
        return Hits(notice=f"no word of the query is known ({asked}): say what somebody does", unknown_words=unknown)
    allowed = search.filter.allowed(gallery) if search.filter else None
    words = gallery.words.scores(text) if weights.words else None
    rows, cosines = _candidates(gallery, query, search, allowed, words)
    if not len(rows):
        return Hits(notice="no clip of the gallery fulfils the conditions")
    said = parse_query(text)
    fits = None
    if weights.attributes and gallery.attributes is not None and said.said:
        fits = agreements(said, Columns(gallery.attributes, rows))
    shared = None if words is None else words[rows]
    total = combined(cosines, fits, shared, weights)
    order = np.argsort(-total, kind="stable")
    if search.per_clip:
        _, first = np.unique(gallery.windows["clip"][rows[order]], return_index=True)
        order = order[np.sort(first)]
    hits = [
        gallery.hit(rank, int(rows[i]), float(total[i]), float(cosines[i]), None if fits is None else float(fits[i]))
        for rank, i in enumerate(order[:k].tolist(), 1)
    ]
    return Hits(hits, gallery=gallery)


def _candidates(
    gallery: Gallery,
    query: FloatArray,
    search: Search,
    allowed: npt.NDArray[np.bool_] | None,
    words: npt.NDArray[np.float32] | None,
) -> tuple[IntArray, FloatArray]:
    """Windows that are looked at closely, ascending, and their cosines."""
    if allowed is not None and np.count_nonzero(allowed) <= _ALL:
        rows = np.flatnonzero(allowed)
    else:
        count = max(WIDE, TIMES * search.k)
        rows = gallery.nearest(query, count, approximate=search.approximate, allowed=allowed)
        if words is not None:
            shared = words if allowed is None else np.where(allowed, words, np.float32(0))
            rows = np.union1d(rows, _best(shared))
    rows = np.sort(rows)
    return rows, scores(np.ascontiguousarray(gallery.embeddings[rows]), np.ascontiguousarray(query, dtype=np.float32))


def _best(words: npt.NDArray[np.float32]) -> IntArray:
    """Windows whose words fit best, of those that have any."""
    found = np.flatnonzero(words)
    if len(found) > _BY_WORDS:
        found = found[np.argpartition(words[found], -_BY_WORDS)[-_BY_WORDS:]]
    return found
