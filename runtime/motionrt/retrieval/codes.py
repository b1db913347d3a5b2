"""Vectors in 8 bits a number, and how far from the truth that can be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.vectors import Vectors

ByteArray = npt.NDArray[np.uint8]
Narrowing = Callable[[FloatArray], FloatArray]
ROUNDING = 2.0**-24  # of one float32 operation
LEVELS, ZERO = 127, 128
SHORTEST, LONGEST = 1e-10, 1e10  # outside, squares may leave float32, and the bounds do not hold
_CHUNK = 2048  # rows that stay in the second-level cache while they are coded
_TINY = np.float32(1e-30)


@dataclass(frozen=True, eq=False)
class Codes:
    """Rows ``v`` as ``scale * (code - 128)``, codes 1 to 255; of 4 bits ``scale * (code - 8)``, codes 1 to 15.

    Attributes:
        width: ``d``, numbers that a float32 score is the sum of.
        scales: ``(N,)`` float32.
        residual: no row is further than this, and what is ``missed``, from what its code stands for (L2 norm).
        longest: no row, and nothing a code stands for, is longer than this.
        coarsest: the largest of the scales.
        bits: of a number.
        missed: ``(N,)`` float32, what is known of each row beside ``residual``; None for nothing.
    """

    width: int
    scales: FloatArray
    coarsest: float
    residual: float
    longest: float
    bits: int = 8
    missed: FloatArray | None = None

    def error(self, query: CodedQuery) -> float:
        """The most by which ``step * scanned`` can be off, without ``missed``: from the float32 score of the rows.

        ``x.v - step z.w = (x - step z).v + step z.(v - w)`` for query x, its code z, row v and its code's value w, by
        Cauchy and Schwarz; and the rounding of both products, in whatever order they add: (d + 2) roundings of
        ``|x||v|`` in float32, and in the scan of the sum of ``scale |z| (255 + 128 + 128)``, of 4 bits
        ``scale |z| (15 + 8 + 8)``: some kernels add the unsigned codes first and take the zeros off at the end.
        """
        rounding = (self.width + 8) * ROUNDING
        exact = query.residual * self.longest + query.length * (self.residual + rounding * self.longest)
        return 1.001 * (exact + rounding * 2.0 ** (self.bits + 1) * self.coarsest * query.step * query.absolute)


@dataclass(frozen=True, eq=False)
class CodedQuery:
    """A query ``x`` as ``step * z`` with whole numbers z, -127 to 127, one of them at an end of it.

    So the scan's own coding of its input, to 127 levels of the largest, finds them as they are, and adds no error.

    Attributes:
        numbers: ``(1, padded)`` float32, z.
        step: one unit of z.
        residual: ``|x - step z|``.
        length: ``max(|x|, |step z|)``.
        absolute: sum of ``|z|``.
    """

    numbers: FloatArray
    step: float
    residual: float
    length: float
    absolute: float


def padded(width: int) -> int:
    """Numbers a row in the scan: a power of two, at least 16."""
    return max(16, 1 << (width - 1).bit_length())


def code_rows(vectors: Vectors, out: ByteArray, narrowed: Narrowing | None = None) -> Codes | None:
    """Code ``vectors`` ``(N, d)``, at least one, into ``out`` ``(N, padded)``; every row has its own scale.

    ``narrowed`` makes the rows that are coded out of vectors. None when one is not finite, or one is longer, or all
    are shorter, than the bounds hold for.
    """
    count, width = vectors.shape
    scales = np.empty(count, dtype=np.float32)
    residual = longest = 0.0
    for start in range(0, count, _CHUNK):
        part = slice(start, start + _CHUNK)
        with np.errstate(over="ignore", invalid="ignore"):
            rows = vectors[part] if narrowed is None else narrowed(vectors[part])
            length = longest_of(rows)
        if not length < LONGEST:  # nor is NaN
            return None
        missed = _code(rows, out[part], scales[part])
        residual, longest = max(residual, missed), max(longest, length)
    if longest <= SHORTEST:
        return None
    residual = residual * 1.001 + 4 * ROUNDING * longest
    return Codes(width, scales, float(scales.max()), residual, longest * 1.001 + residual)


def _code(rows: FloatArray, out: ByteArray, scales: FloatArray) -> float:
    """Write codes and scales; gives how far the farthest row is from what its code stands for."""
    np.maximum(np.maximum(rows.max(axis=1), -rows.min(axis=1)), _TINY, out=scales)
    scales /= LEVELS
    whole = np.rint(rows * (1 / scales)[:, None])
    difference: FloatArray = whole * scales[:, None] - rows
    whole += ZERO
    out[:, : rows.shape[1]] = whole
    out[:, rows.shape[1] :] = ZERO
    return longest_of(difference)


def code_query(query: npt.NDArray[np.float64]) -> CodedQuery | None:
    """Code ``query`` ``(d,)``; None when it is zero or of a size that float32 products do not keep."""
    largest = float(np.abs(query).max(initial=0.0))
    if not SHORTEST < largest < LONGEST:
        return None
    step = largest / LEVELS
    whole = np.rint(query / step)
    numbers = np.zeros((1, padded(len(query))), dtype=np.float32)
    numbers[0, : len(query)] = whole
    residual = _norm(query - step * whole)
    return CodedQuery(numbers, step, residual, _norm(query) + residual, float(np.abs(whole).sum()))


def lengths(rows: FloatArray) -> FloatArray:
    """``(N,)`` L2 norms of rows ``(N, d)``."""
    result: FloatArray = np.sqrt(np.einsum("nd,nd->n", rows, rows))
    return result


def longest_of(rows: FloatArray) -> float:
    """The largest of the rows' L2 norms; NaN where one is."""
    return float(lengths(rows).max())


def _norm(vector: npt.NDArray[np.float64]) -> float:
    return float(np.sqrt(vector @ vector))
