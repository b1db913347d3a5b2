"""How cosine, measured attributes and words make one score; every weight is here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Weights:
    """What each part of a score counts; chosen on the validation split (docs/search.md).

    Attributes:
        embedding: of the cosine of text and motion.
        attributes: of how well measured attributes agree with the text (0 to 1).
        words: of the words that text and library share (0 to 1).
    """

    embedding: float = 1.0
    attributes: float = 0.7
    words: float = 0.6


DEFAULT = Weights()
EMBEDDING_ONLY = Weights(1.0, 0.0, 0.0)


def combined(
    cosines: npt.NDArray[np.floating],
    agreements: npt.NDArray[np.floating] | None,
    words: npt.NDArray[np.floating] | None,
    weights: Weights,
) -> FloatArray:
    """``(N,)`` float32: the weighted sum of what there is; with cosines alone it is the cosine.

    Args:
        cosines: ``(N,)`` of text and motions.
        agreements: ``(N,)`` 0 to 1, 0.5 for neither; None where the text says nothing that can be measured.
        words: ``(N,)`` 0 to 1; None where no clip has a word of the text.
        weights: of the three.
    """
    score = weights.embedding * np.asarray(cosines, dtype=np.float64)
    if agreements is not None:
        score = score + weights.attributes * (np.asarray(agreements) - 0.5)
    if words is not None:
        score = score + weights.words * np.asarray(words)
    return np.asarray(score, dtype=np.float32)
