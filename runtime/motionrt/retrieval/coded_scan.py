"""A first pass over a large gallery in 8 or 4 bits, which leaves few vectors to compare, and provably the right ones.

The scan reads a quarter of the bytes, and memory is what a scan waits for; in a library whose embeddings keep to few
directions (:mod:`~motionrt.retrieval.narrow`) it reads a sixteenth, and in a large one whose embeddings do not an
eighth (:mod:`~motionrt.retrieval.nibbles`). No float32 score is above the scan's by more than a
known error (:meth:`~motionrt.retrieval.codes.Codes.error`). So with the float32 scores of any k vectors at hand, the
worst of them F, a vector that the scan puts below F - error scores less than each of the k: it is not among the k
best, and does not tie with them. What remains, some dozens to hundreds, is compared in float32.
"""

from __future__ import annotations

import mmap
import sys
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.models.engine import CPU, Providers, engine, open_session
from motionrt.models.sessions import quiet_options
from motionrt.models.threads import thread_count
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.codes import LEVELS, ByteArray, CodedQuery, Codes, code_query, code_rows, padded
from motionrt.retrieval.narrow import Directions
from motionrt.retrieval.nibbles import code_nibbles
from motionrt.retrieval.scan_graph import scan_model
from motionrt.retrieval.scores import IntArray, scores
from motionrt.retrieval.vectors import Vectors

if TYPE_CHECKING:
    from onnxruntime import InferenceSession

Mask = npt.NDArray[np.bool_]
MAX_WIDTH = 256  # one block of the scan's product
NARROW_FROM = 50_000  # below, the directions save less than a tenth of a millisecond
NIBBLES_FROM = 128  # numbers a vector; below, 4 bits are read no faster
THREADED_FROM = 200_000  # below, a second thread's start takes what it saves
_MAX_COLUMNS, _ROWS = 4096, 16
_TRIED = 64  # vectors whose float32 scores say how good the k best must be
_TRIALS, _FEW = 8, 32  # questions that 4 bits must answer, and how few may be left: one in so many
_PIECE = 1 << 15  # scores that stay in the first-level caches


class CodedScan:
    """The 8-bit or 4-bit copy of a set of vectors; :meth:`build` makes it. May be used from several threads."""

    def __init__(
        self, vectors: Vectors, directions: Directions | None, providers: Providers = CPU, bits: int = 8
    ) -> None:
        self._vectors, self._bits = vectors, bits
        self._directions, self._providers = directions, providers
        self._width = padded(vectors.shape[1] if directions is None else directions.width)

    @classmethod
    def build(cls, vectors: Vectors, providers: Providers = CPU) -> CodedScan | None:
        """Code ``vectors`` ``(N, d)``, C-ordered float32; None where that cannot work, and float32 has to do.

        That is: more than 256 numbers a vector, numbers not finite or of extreme size, or a machine whose 8-bit
        product is not exact.
        """
        if vectors.size == 0:
            return None
        large = len(vectors) >= NARROW_FROM
        made = cls(vectors, Directions.of(vectors) if large else None, providers)
        if made._width > MAX_WIDTH:
            return None
        if large and made._directions is None and made._width >= NIBBLES_FROM:
            halved = cls(vectors, None, providers, bits=4)
            if _is_exact(made._width, providers, bits=4) and halved._code() and halved._narrows_down():
                return halved
        return made if _is_exact(made._width, providers) and made._code() else None

    @property
    def width(self) -> int:
        """Bytes that are read of every vector."""
        return self._width * self._bits // 8

    def candidates(self, query: FloatArray, k: int, allowed: Mask | None = None) -> IntArray | None:
        """Ascending indices, all of the k best and all that tie with them among them; None when too many remain.

        ``allowed`` ``(N,)`` says which count, at least k; by default all.
        """
        exact = query.astype(np.float64)
        coded = code_query(exact if self._directions is None else self._directions.query(exact))
        count = len(self._vectors)
        columns = min(_MAX_COLUMNS, count // _ROWS)
        if coded is None or k > columns:
            return None
        scanned = _run(self._session, coded.numbers)
        if allowed is not None:
            scanned = np.where(allowed, scanned, np.float32(-np.inf))
        rows = count // columns
        table = scanned[: rows * columns].reshape(rows, columns)
        tops = table.max(axis=0)
        kth = self._score_of_kth(table, tops, query, k)
        if kth is None:
            return None
        least = _below((kth - self._error(coded)) / coded.step)
        missed = self._codes.missed
        if missed is not None:
            found = _within(scanned, missed, np.float32(1.001 * coded.length / coded.step), least)
        else:
            rest = np.flatnonzero(scanned[rows * columns :] >= least) + rows * columns
            found = np.concatenate([_at_least(table, tops, least), rest])
        return found if 4 * len(found) < count else None

    def _narrows_down(self) -> bool:
        """Whether few vectors remain of most questions, tried with some of the vectors themselves."""
        asked = self._vectors[np.linspace(0, len(self._vectors) - 1, _TRIALS).astype(np.int64)]
        found = [self.candidates(query, 10) for query in asked]
        few = sum(one is not None and len(one) * _FEW < len(self._vectors) for one in found)
        return 2 * few > _TRIALS

    def _error(self, query: CodedQuery) -> float:
        """How far a vector's float32 score can be above the scan's, which is ``step`` times what it gives."""
        error = self._codes.error(query)
        if self._directions is None:
            return error
        return error + self._directions.rounding(query.length, 1.01 * self._codes.longest)

    def _score_of_kth(self, table: FloatArray, tops: FloatArray, query: FloatArray, k: int) -> float | None:
        """The k-th of the float32 scores of vectors on top of the best columns; None without so many."""
        tried = min(max(_TRIED, 2 * k), len(tops))
        columns = np.argpartition(tops, len(tops) - tried)[len(tops) - tried :]
        columns = columns[tops[columns] > -np.inf]
        if len(columns) < k:
            return None
        vectors = table[:, columns].argmax(axis=0) * len(tops) + columns
        return float(np.sort(scores(self._vectors[vectors], query))[-k])

    def _code(self) -> bool:
        """Make the codes and the session that scans them; False when the vectors have no codes.

        The codes' memory is given back where the session made a copy of its own, as it does to arrange them.
        """
        store = _memory(len(self._vectors) * self.width)
        self._memory = np.frombuffer(store, dtype=np.uint8).reshape(-1, self.width)  # the session may read it
        codes = self._coded()
        if codes is None:
            return False
        self._codes = codes
        self._session = _open(self._memory, codes.scales, self._providers, self._bits)
        if sys.platform != "linux":  # elsewhere the pages stay
            return True
        probe = np.full((1, self._width), LEVELS, dtype=np.float32)
        before = _run(self._session, probe)
        store.madvise(mmap.MADV_DONTNEED)
        if not np.array_equal(before, _run(self._session, probe)):
            self._coded()
        return True

    def _coded(self) -> Codes | None:
        if self._bits == 4:
            return code_nibbles(self._vectors, self._memory)
        return code_rows(self._vectors, self._memory, self._directions.rows if self._directions is not None else None)


def _memory(size: int) -> mmap.mmap:
    """Memory that can be given back while arrays still point to it; it reads as zeros then."""
    if sys.platform == "linux":
        return mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    return mmap.mmap(-1, size)


def _at_least(table: FloatArray, tops: FloatArray, least: np.float32) -> IntArray:
    columns = np.flatnonzero(tops >= least)
    row, place = np.nonzero(table[:, columns] >= least)
    return row * len(tops) + columns[place]


def _within(scanned: FloatArray, missed: FloatArray, weight: np.float32, least: np.float32) -> IntArray:
    """Ascending numbers of those that reach ``least`` with so many times what they miss, piece by piece."""
    found = []
    for start in range(0, len(scanned), _PIECE):
        most = missed[start : start + _PIECE] * weight
        most += scanned[start : start + _PIECE]
        found.append(np.flatnonzero(most >= least) + start)
    return np.concatenate(found)


def _below(value: float) -> np.float32:
    below: np.float32 = np.nextafter(np.float32(value), np.float32(-np.inf))
    return below


def _open(codes: ByteArray, scales: FloatArray, providers: Providers, bits: int) -> InferenceSession:
    rows, size = codes.shape
    options = quiet_options(thread_count(None) if rows >= THREADED_FROM else 1)
    values = [engine().OrtValue.ortvalue_from_numpy(array) for array in (codes.reshape(rows, 1, size), scales)]
    options.add_external_initializers(["codes", "scales"], values)
    return open_session(scan_model(rows, size * 8 // bits, bits), options, providers)


def _run(session: InferenceSession, numbers: FloatArray) -> FloatArray:
    result: FloatArray = session.run(None, {"query": numbers})[0][0]
    return result


def _is_exact(width: int, providers: Providers = CPU, bits: int = 8) -> bool:
    """Whether this machine's product is exact where its sums are largest, which is where some saturate.

    All sums are below 2^24, so float32 holds them, whatever the order.
    """
    random = np.random.default_rng(0)
    zero = 1 << (bits - 1)
    codes = random.integers(1, 2 * zero, (67, width), dtype=np.uint8)
    codes[0], codes[1] = 2 * zero - 1, 1
    codes[2, ::2], codes[3, 1::2] = 2 * zero - 1, 1
    signs = np.where(np.arange(width) % np.array([[1], [2], [3]]) == 0, LEVELS, -LEVELS)
    mixed = np.clip(random.integers(-400, 400, (2, width)), -LEVELS, LEVELS)
    stored = codes if bits == 8 else codes[:, ::2] | (codes[:, 1::2] << np.uint8(4))
    session = _open(stored, np.ones(len(codes), dtype=np.float32), providers, bits)
    for query in np.concatenate([signs, mixed]):
        exact = (codes.astype(np.int64) - zero) @ query
        if not np.array_equal(_run(session, query[None].astype(np.float32)), exact):
            return False
    return True
