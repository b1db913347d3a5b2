"""Vectors in 4 bits a number: half the bytes to read, and what every single row loses by it is kept beside.

For vectors that leave no few directions alone (:mod:`~motionrt.retrieval.narrow`), where 8 bits take 256 bytes each.
The bound on a row is what that row misses, not what the worst of all does: rows with outliers miss twice as much.
"""

from __future__ import annotations

import numpy as np

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.codes import LONGEST, ROUNDING, SHORTEST, ByteArray, Codes, lengths, longest_of
from motionrt.retrieval.vectors import Vectors

HIGHEST, ZERO = 7, 8  # codes are 1 to 15
_STEP = 0.36  # of a row's spread: least loss for normally distributed numbers in 15 steps
_CHUNK = 2048
_TINY = np.float32(1e-30)


def code_nibbles(vectors: Vectors, out: ByteArray) -> Codes | None:
    """Code ``vectors`` ``(N, d)`` into ``out`` ``(N, padded / 2)``: of two numbers the first is in the low bits.

    None when one is not finite, or one is longer, or all are shorter, than the bounds hold for.
    """
    count, width = vectors.shape
    scales, missed = np.empty((2, count), dtype=np.float32)
    longest = 0.0
    for start in range(0, count, _CHUNK):
        part = slice(start, start + _CHUNK)
        with np.errstate(over="ignore", invalid="ignore"):
            rows = vectors[part]
            length = longest_of(rows)
        if not length < LONGEST:  # nor is NaN
            return None
        missed[part] = _code(rows, out[part], scales[part])
        longest = max(longest, length)
    if longest <= SHORTEST:
        return None
    missed *= np.float32(1.001)
    missed += np.float32(4 * ROUNDING * longest)
    return Codes(width, scales, float(scales.max()), 0.0, 1.001 * longest + float(missed.max()), bits=4, missed=missed)


def _code(rows: FloatArray, out: ByteArray, scales: FloatArray) -> FloatArray:
    """Write codes and scales; gives how far each row is from what its code stands for."""
    largest = np.maximum(rows.max(axis=1), -rows.min(axis=1)) / HIGHEST
    spread = lengths(rows) * np.float32(_STEP / np.sqrt(rows.shape[1]))
    np.maximum(np.minimum(largest, spread), _TINY, out=scales)
    whole = np.clip(np.rint(rows * (1 / scales)[:, None]), -HIGHEST, HIGHEST)
    difference: FloatArray = whole * scales[:, None] - rows
    codes = np.full((len(rows), 2 * out.shape[1]), ZERO, dtype=np.uint8)
    codes[:, : rows.shape[1]] = whole + ZERO
    np.left_shift(codes[:, 1::2], 4, out=out)
    out |= codes[:, ::2]
    return lengths(difference)
