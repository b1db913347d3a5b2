"""Writing columns as a safetensors file; :mod:`motionrt.untrusted.safetensors` reads them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.untrusted.safetensors import DTYPES

Array = npt.NDArray[Any]
_ALIGNED = 64  # bytes: the first column begins at a multiple of it
_NAMES = {dtype: name for name, dtype in DTYPES.items()}


@dataclass(frozen=True)
class Pieces:
    """A column that is made piece by piece, so that it need not lie in memory.

    Attributes:
        dtype: of its numbers.
        shape: of all of it.
        make: gives arrays that, one behind the other, are the column.
    """

    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    make: Callable[[], Iterable[Array]]


def column_writer(columns: Mapping[str, Array | Pieces], metadata: Mapping[str, str]) -> Callable[[IO[bytes]], None]:
    """Writes columns by name to an open file; the same columns give the same bytes."""
    return partial(_write, columns=columns, metadata=metadata)


def _write(file: IO[bytes], columns: Mapping[str, Array | Pieces], metadata: Mapping[str, str]) -> None:
    ordered = sorted(columns, key=lambda name: (-columns[name].dtype.itemsize, name))  # so that all are aligned
    header: dict[str, Any] = {"__metadata__": dict(metadata)}
    end = 0
    for name in ordered:
        column = columns[name]
        start, end = end, end + int(np.prod(column.shape, dtype=np.int64)) * column.dtype.itemsize
        kind = _NAMES[column.dtype.newbyteorder("<")]
        header[name] = {"dtype": kind, "shape": list(column.shape), "data_offsets": [start, end]}
    told = json.dumps(header, separators=(",", ":")).encode("ascii")
    told += b" " * (-(8 + len(told)) % _ALIGNED)
    file.write(len(told).to_bytes(8, "little") + told)
    for name in ordered:
        column = columns[name]
        for piece in column.make() if isinstance(column, Pieces) else [column]:
            file.write(
                np.ascontiguousarray(piece, column.dtype.newbyteorder("<")).data.cast("B") if piece.size else b""
            )
