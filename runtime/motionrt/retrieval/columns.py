"""Attributes of a gallery's windows as named columns, read when asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval.vectors import Vectors

Array = npt.NDArray[np.float64]
_PLACE = {name: k for k, name in enumerate(ATTRIBUTES)}


class Columns(Mapping[str, Array]):
    """``name -> (N,)`` float64 of the rows of a table ``(W, A)``.

    Args:
        table: attributes, in the order of :data:`motionrt.motion.attributes.ATTRIBUTES`.
        rows: which of them, all by default.
    """

    def __init__(self, table: Vectors, rows: npt.NDArray[np.integer] | None = None) -> None:
        self._table = table if rows is None else table[rows]
        self._read: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        if name not in self._read:
            self._read[name] = self._table[:, _PLACE[name]].astype(np.float64)
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(ATTRIBUTES)

    def __len__(self) -> int:
        return len(ATTRIBUTES)
