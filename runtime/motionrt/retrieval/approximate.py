"""Approximate search for galleries of hundreds of thousands of windows: a graph of neighbours  [HNSW, 8 bit].

It needs the package faiss-cpu (``pip install "motionrt[ann]"``), finds nearly all of the best (measured: 99 % and
more of the ten best), and takes minutes to build for a million vectors: so it is kept beside the gallery.
"""

from __future__ import annotations

import importlib
import os
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import MissingDependencyError
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.narrow import Directions
from motionrt.retrieval.scores import IntArray, scores, top
from motionrt.retrieval.search import Mask, VectorIndex
from motionrt.retrieval.store import TEMPORARY
from motionrt.retrieval.vectors import Vectors

WORTHWHILE_FROM = 50_000  # below, the exact answer takes half a millisecond at most
_GRAPH, _REDUCED = "HNSW32,SQ8", "PCA64,HNSW32,SQ8"  # 32 neighbours a vector, one byte a number
_TRAINING = 50_000  # vectors that the 8-bit levels are fitted to
_ADDED = 1 << 18  # vectors that are added at once
_WIDEN, _LEAST = 4, 40  # how many are looked at for every one wanted: the graph's own scores are 8 bit
_BREADTH, _MOST = 64, 2_000


class ApproximateIndex:
    """The nearest by the graph of neighbours, scored in float32. May be used from several threads.

    Small sets, and questions for very many, are answered by ``exact``.

    Args:
        vectors: ``(N, d)`` float32 unit vectors.
        exact: the exact index of the same vectors.
        file: where the graph is kept, named after the vectors; None keeps it in memory.
    """

    def __init__(self, vectors: Vectors, exact: VectorIndex, file: Path | None = None) -> None:
        self._vectors = vectors
        self._exact = exact
        self._file = file
        self._graph: Any = None
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._vectors)

    def __reduce__(self) -> tuple[type[ApproximateIndex], tuple[Vectors, VectorIndex, Path | None]]:
        return ApproximateIndex, (self._vectors, self._exact, self._file)

    def prepare(self) -> None:
        """Read the graph, or build it and keep it: seconds for 100,000 vectors, minutes for a million.

        Raises:
            MissingDependencyError: faiss-cpu is not installed.
        """
        with self._lock:
            if self._graph is None and len(self) >= WORTHWHILE_FROM:
                self._graph = self._opened(_faiss())

    def nearest(self, query: FloatArray, k: int, allowed: Mask | None = None) -> tuple[IntArray, FloatArray]:
        """Indices and scores ``(min(k, N),)`` of vectors near to ``query`` ``(d,)``, best first.

        ``allowed`` ``(N,)`` says which may be found; where that is less than half of them the answer is exact.

        Raises:
            MissingDependencyError: faiss-cpu is not installed.
        """
        wanted = max(_WIDEN * k, _LEAST)
        selective = allowed is not None and 2 * np.count_nonzero(allowed) < len(self)
        if len(self) < WORTHWHILE_FROM or wanted > _MOST or selective or not np.isfinite(query).all():
            return self._exact.nearest(query, k, allowed)
        if self._graph is None:
            self.prepare()
        query = np.ascontiguousarray(query, dtype=np.float32)
        found = self._near(query, wanted)
        if allowed is not None:
            found = found[allowed[found]]
        if len(found) < k:  # an island in the graph
            return self._exact.nearest(query, k, allowed)
        best, values = top(scores(self._vectors[found], query), k)
        return found[best], values

    def _near(self, query: FloatArray, count: int) -> IntArray:
        """About ``count`` indices, ascending."""
        faiss = _faiss()
        options = faiss.SearchParametersHNSW(efSearch=max(_BREADTH, count))
        if isinstance(self._graph, faiss.IndexPreTransform):
            options = faiss.SearchParametersPreTransform(index_params=options)
        _, found = self._graph.search(query[None], count, params=options)
        return np.unique(found[0][(found[0] >= 0) & (found[0] < len(self))]).astype(np.int64)

    def _opened(self, faiss: Any) -> Any:
        if self._file is not None and self._file.is_file():
            with suppress(RuntimeError):  # damaged, or of another faiss: built again
                graph = faiss.read_index(os.fspath(self._file))
                if (graph.ntotal, graph.d) == self._vectors.shape:
                    return graph
        graph = self._built(faiss)
        if self._file is not None:
            _keep(faiss, graph, self._file)
        return graph

    def _built(self, faiss: Any) -> Any:
        """The graph, of 64 numbers a vector where those hold nearly all, which takes half as long.

        By distance: for unit vectors that is the order of the cosines, and a graph of distances is the better one.
        """
        vectors = self._vectors
        directions = Directions.of(vectors)
        kind = _REDUCED if directions is not None and directions.width == 64 else _GRAPH
        graph = faiss.index_factory(vectors.shape[1], kind, faiss.METRIC_L2)
        graph.train(np.ascontiguousarray(vectors[:: max(1, len(vectors) // _TRAINING)]))
        for start in range(0, len(vectors), _ADDED):
            graph.add(np.ascontiguousarray(vectors[start : start + _ADDED]))
        return graph


def _keep(faiss: Any, graph: Any, file: Path) -> None:
    """Write the graph in one step; where the disk refuses it stays in memory."""
    import tempfile  # slow to import, and needed once a gallery

    with suppress(OSError, RuntimeError):
        handle, name = tempfile.mkstemp(prefix=TEMPORARY, dir=file.parent)
        os.close(handle)
        try:
            faiss.write_index(graph, name)
            Path(name).replace(file)
        finally:
            Path(name).unlink(missing_ok=True)


def _faiss() -> Any:
    try:
        return importlib.import_module("faiss")
    except ImportError as error:
        raise MissingDependencyError(
            'approximate search needs the package faiss-cpu: pip install "motionrt[ann]"; without it, search exactly'
        ) from error
