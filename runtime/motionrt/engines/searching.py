"""A search in a store: what it finds nearest, ranked as in a gallery."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.engines.store import GalleryStore, Nearest
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Hit, Hits, Search
from motionrt.retrieval.columns import Columns
from motionrt.retrieval.finding import TIMES, WIDE
from motionrt.retrieval.ranking import combined
from motionrt.retrieval.scores import scores
from motionrt.retrieval.search import checked_k
from motionrt.text import agreements, parse_query


def find_in(store: GalleryStore, texts: Sequence[str], queries: FloatArray, search: Search) -> list[Hits]:
    """The best hits for texts and their embeddings ``(Q, 256)``: by cosine and attributes.

    A store knows nothing of words, whose weight is not used.
    """
    count = max(WIDE, TIMES * checked_k(search.k))
    found = store.nearest(queries, count, search.filter, approximate=search.approximate)
    return [_ranked(*one, search) for one in zip(texts, queries, found, strict=True)]


def _ranked(text: str, query: FloatArray, found: Nearest, search: Search) -> Hits:
    if not len(found.clips):
        return Hits(notice="no clip of the store fulfils the conditions")
    cosines = scores(np.ascontiguousarray(found.embeddings), np.ascontiguousarray(query, dtype=np.float32))
    said = parse_query(text)
    fits = None
    if search.weights.attributes and found.attributes is not None and said.said:
        fits = agreements(said, Columns(found.attributes))
    total = combined(cosines, fits, None, search.weights)
    names = np.array(found.clips, dtype=object)
    order = np.lexsort((found.spans[:, 0], names.astype(str), -total))
    if search.per_clip:
        _, first = np.unique(names[order].astype(str), return_index=True)
        order = order[np.sort(first)]
    return Hits(
        Hit(
            rank, float(total[i]), found.clips[i], None, float(found.spans[i, 0]), float(found.spans[i, 1]),
            found.texts[i], float(cosines[i]), None if fits is None else float(fits[i]),
        )
        for rank, i in enumerate(order[: search.k].tolist(), 1)
    )  # fmt: skip
