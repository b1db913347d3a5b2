"""Sequences whose items are made when they are asked for."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any, TypeVar, overload

import numpy as np
import numpy.typing as npt

T = TypeVar("T")


class Lazy(Sequence[T]):
    """A sequence that is equal to every sequence of equal items."""

    @abstractmethod
    def _item(self, index: int) -> T:
        """The item at ``index``, 0 to ``len - 1``."""

    @overload
    def __getitem__(self, index: int) -> T: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[T, ...]: ...

    def __getitem__(self, index: int | slice) -> T | tuple[T, ...]:
        if isinstance(index, slice):
            return tuple(self._item(i) for i in range(*index.indices(len(self))))
        place = index + len(self) if index < 0 else index
        if not 0 <= place < len(self):
            raise IndexError(index)
        return self._item(place)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Lazy | tuple):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self)})"


class Chain(Lazy[T]):
    """The chosen items of several sequences, one behind the other.

    Args:
        parts: sequences, each with the ascending numbers of the items that count; None for all.
    """

    def __init__(self, parts: Sequence[tuple[Sequence[T], npt.NDArray[np.integer[Any]] | None]]) -> None:
        self._parts = parts
        lengths = [len(items) if chosen is None else len(chosen) for items, chosen in parts]
        self._ends = np.cumsum(lengths, dtype=np.int64)

    def __len__(self) -> int:
        return int(self._ends[-1]) if len(self._ends) else 0

    def _item(self, index: int) -> T:
        number = int(np.searchsorted(self._ends, index, side="right"))
        place = index - (int(self._ends[number - 1]) if number else 0)
        items, chosen = self._parts[number]
        return items[place if chosen is None else int(chosen[place])]
