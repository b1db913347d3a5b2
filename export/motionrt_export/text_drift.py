"""How far texts of a file are from those of torch, one by one as the runtime feeds them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from motionrt_export.calibration import alone
from motionrt_export.measures import Figures, measure
from motionrt_export.references import Reference


class TextDrift:
    """Texts alone: in batches rows of dynamic int8 share a scale, which no use of the runtime lets them do."""

    def __init__(self, encode: Callable[[str], list[int]], texts: Sequence[str]) -> None:
        self._encode, self._texts = encode, tuple(texts)

    def __call__(self, found: Reference, expected: Reference) -> Figures:
        """Figures of ``alone``: errors of the embeddings, the worst of all texts."""
        feeds = [alone(self._encode(text)) for text in self._texts]
        ours, theirs = (np.concatenate([graph(feed)["embedding"] for feed in feeds]) for graph in (found, expected))
        return {"alone": measure(ours, theirs)}
