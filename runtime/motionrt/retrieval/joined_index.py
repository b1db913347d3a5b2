"""One index out of those of several blocks of vectors: the answer of one over all of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.scores import IntArray
from motionrt.retrieval.search import Mask, VectorIndex
from motionrt.retrieval.vectors import Block


class JoinedIndex:
    """The nearest of all blocks, whose chosen vectors are numbered one block behind the other.

    Args:
        blocks: vectors, and which of them count.
        make: makes the index of a block's vectors, of all of them.
    """

    def __init__(self, blocks: Sequence[Block], make: Callable[[Block], VectorIndex]) -> None:
        self._blocks = blocks
        self.indexes = [make(block) for block in blocks]
        self._firsts = np.cumsum([0, *(len(block) for block in blocks)]).tolist()
        self._chosen = [_mask(block) for block in blocks]

    def __len__(self) -> int:
        return int(self._firsts[-1])

    def prepare(self) -> None:
        """Get ready for many queries."""
        for index in self.indexes:
            index.prepare()

    def nearest(self, query: FloatArray, k: int, allowed: Mask | None = None) -> tuple[IntArray, FloatArray]:
        """See :class:`VectorIndex`; equal scores stand in the order of their numbers."""
        numbers, values = [], []
        for block, index, chosen, first in zip(self._blocks, self.indexes, self._chosen, self._firsts, strict=False):
            part = None if allowed is None else allowed[first : first + len(block)]
            if part is not None and not part.any():
                continue
            found, scores = index.nearest(query, k, _spread(chosen, block, part))
            numbers.append(first + (found if block.chosen is None else np.searchsorted(block.chosen, found)))
            values.append(scores)
        if not numbers:
            return np.zeros(0, np.int64), np.zeros(0, np.float32)
        found, scores = np.concatenate(numbers), np.concatenate(values)
        order = np.lexsort((found, -scores))[:k]
        return found[order].astype(np.int64), scores[order]


def _mask(block: Block) -> Mask | None:
    """``(N,)`` which of a block's vectors count; None for all."""
    if block.chosen is None:
        return None
    mask = np.zeros(len(block.vectors), dtype=bool)
    mask[block.chosen] = True
    return mask


def _spread(chosen: Mask | None, block: Block, allowed: Mask | None) -> Mask | None:
    """``(N,)`` which of a block's vectors may be found, of those that count."""
    if allowed is None or block.chosen is None:
        return chosen if allowed is None else allowed
    mask = np.zeros(len(block.vectors), dtype=bool)
    mask[block.chosen] = allowed
    return mask
