"""Vectors as they are stored, in float32, float16 or 8 bits, in one piece or several; read where they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.words import shown

PRECISIONS = ("float32", "float16", "int8")
CHUNK = 8192  # rows that are decoded at once
_LEVELS = 127
Numbers = npt.NDArray[np.integer[Any]]


def checked_precision(precision: object) -> str:
    """The name of a precision; InvalidInputError for any other value."""
    if not isinstance(precision, str) or precision not in PRECISIONS:
        raise InvalidInputError(f"a precision is one of {', '.join(PRECISIONS)}, not {shown(precision)}")
    return precision


class Stored:
    """A read-only array of float32 vectors ``(N, d)`` that is made where it is indexed.

    Takes whole numbers, slices, arrays of numbers or booleans, and pairs of one of these and columns. NumPy's functions
    take it for an array, and read all of it.
    """

    shape: tuple[int, int]
    dtype = np.dtype(np.float32)
    ndim = 2

    def rows(self, numbers: Numbers) -> FloatArray:
        """The vectors of these numbers, ``(n, d)``."""
        raise NotImplementedError

    def span(self, start: int, stop: int) -> FloatArray:
        """Vectors ``start`` to ``stop`` (exclusive), ``(n, d)``."""
        raise NotImplementedError

    def __len__(self) -> int:
        return self.shape[0]

    @property
    def size(self) -> int:
        """How many numbers it has."""
        return self.shape[0] * self.shape[1]

    def __getitem__(self, key: Any) -> FloatArray:
        if isinstance(key, tuple):
            rows, *rest = key
            found: FloatArray = (
                self[rows][(..., *rest)] if np.ndim(rows) or isinstance(rows, slice) else self[rows][rest[0]]
            )
            return found
        if isinstance(key, slice):
            start, stop, step = key.indices(len(self))
            return self.span(start, max(start, stop)) if step == 1 else self.rows(np.arange(start, stop, step))
        numbers = np.asarray(key)
        if numbers.dtype == bool:
            return self.rows(np.flatnonzero(numbers))
        if numbers.ndim == 0:
            one: FloatArray = self.rows(np.array([range(len(self))[int(numbers)]]))[0]
            return one
        return self.rows(np.where(numbers < 0, numbers + len(self), numbers))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return self.span(0, len(self)).astype(dtype or np.float32, copy=False)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        return getattr(ufunc, method)(*(np.asarray(i) if isinstance(i, Stored) else i for i in inputs), **options)

    def __matmul__(self, other: Any) -> Any:
        return np.asarray(self) @ other

    def copy(self) -> FloatArray:
        """All of it, as an array of its own."""
        return np.array(self)


Vectors = FloatArray | Stored
"""Vectors ``(N, d)``, float32 wherever they are read."""


class Packed(Stored):
    """Vectors that are stored in fewer bits.

    Args:
        numbers: ``(N, d)`` float16, or int8.
        scales: ``(N,)`` float32, what one step of a row's int8 numbers is; None for float16.
    """

    def __init__(self, numbers: npt.NDArray[Any], scales: FloatArray | None = None) -> None:
        self.numbers, self.scales = numbers, scales
        self.shape = (numbers.shape[0], numbers.shape[1])

    @property
    def precision(self) -> str:
        """Which of :data:`PRECISIONS`."""
        return "float16" if self.scales is None else "int8"

    def rows(self, numbers: Numbers) -> FloatArray:  # noqa: D102 - as all do
        return self._decoded(self.numbers[numbers], None if self.scales is None else self.scales[numbers])

    def span(self, start: int, stop: int) -> FloatArray:  # noqa: D102 - as all do
        return self._decoded(self.numbers[start:stop], None if self.scales is None else self.scales[start:stop])

    def _decoded(self, numbers: npt.NDArray[Any], scales: FloatArray | None) -> FloatArray:
        vectors: FloatArray = numbers.astype(np.float32)
        if scales is not None:
            vectors *= scales[:, None]
        return vectors


@dataclass(frozen=True, eq=False)
class Block:
    """A piece of :class:`Blocks`: the vectors of one segment.

    Attributes:
        vectors: ``(N, d)``.
        chosen: ascending numbers of those that count; None for all.
        neighbours: where their graph for approximate search is kept, if anywhere.
    """

    vectors: Vectors
    chosen: Numbers | None = None
    neighbours: Path | None = None

    def __len__(self) -> int:
        return len(self.vectors) if self.chosen is None else len(self.chosen)

    def rows(self, numbers: Numbers) -> FloatArray:
        """The vectors of these numbers, counted among the chosen."""
        found: FloatArray = self.vectors[numbers if self.chosen is None else self.chosen[numbers]]
        return found


class Blocks(Stored):
    """The vectors of several blocks, one behind the other, as one array."""

    def __init__(self, blocks: Sequence[Block]) -> None:
        self.blocks = tuple(blocks)
        self.ends = np.cumsum([len(block) for block in blocks], dtype=np.int64)
        self.shape = (int(self.ends[-1]), self.blocks[0].vectors.shape[1])

    def rows(self, numbers: Numbers) -> FloatArray:  # noqa: D102 - as all do
        found = np.empty((len(numbers), self.shape[1]), np.float32)
        owner = np.searchsorted(self.ends, numbers, side="right")
        for k, block in enumerate(self.blocks):
            mine = np.flatnonzero(owner == k)
            if len(mine):
                found[mine] = block.rows(numbers[mine] - (self.ends[k] - len(block)))
        return found

    def span(self, start: int, stop: int) -> FloatArray:  # noqa: D102 - as all do
        return self.rows(np.arange(start, stop))

    def __getitem__(self, key: Any) -> FloatArray:
        if isinstance(key, tuple) and key[0] == slice(None):  # whole columns, which may lie one behind the other
            parts = [block.vectors[key] for block in self.blocks]
            picked = [p if b.chosen is None else p[b.chosen] for p, b in zip(parts, self.blocks, strict=True)]
            return np.concatenate(picked)
        return super().__getitem__(key)


def chunks(vectors: Vectors, numbers: Numbers | None = None) -> Iterator[FloatArray]:
    """The vectors, or those of the given numbers, piece by piece."""
    for start in range(0, len(vectors if numbers is None else numbers), CHUNK):
        part = slice(start, start + CHUNK)
        yield vectors[part] if numbers is None else vectors[numbers[part]]


def scales_of(vectors: FloatArray) -> FloatArray:
    """``(N,)`` what one step of each row's 8-bit numbers is."""
    largest: FloatArray = np.maximum(np.abs(vectors).max(axis=1, initial=0), np.float32(1e-30))
    return largest / np.float32(_LEVELS)


def coded(vectors: FloatArray, scales: FloatArray) -> npt.NDArray[np.int8]:
    """Vectors as 8-bit numbers, -127 to 127, in steps of each row's scale."""
    numbers: npt.NDArray[np.int8] = np.rint(vectors / scales[:, None]).astype(np.int8)
    return numbers
