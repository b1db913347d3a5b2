"""Overlap of time spans, for moment retrieval  [TMR 4.5]."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError

THRESHOLDS = (0.3, 0.5, 0.7)
CURVE = tuple(round(0.1 * step, 1) for step in range(1, 11))
"""Overlaps of the accuracy curve of TMR 4.5."""


def temporal_iou(first: npt.ArrayLike, second: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Intersection over union of spans ``(..., 2)`` of start and end, in any one unit; shapes broadcast.

    Two empty spans have an overlap of 0.
    """
    a, b = _spans(first), _spans(second)
    shared = np.minimum(a[..., 1], b[..., 1]) - np.maximum(a[..., 0], b[..., 0])
    shared = np.maximum(shared, 0.0)
    union = (a[..., 1] - a[..., 0]) + (b[..., 1] - b[..., 0]) - shared
    return np.asarray(shared / np.where(union > 0, union, 1.0))


def localisation_accuracy(
    found: npt.ArrayLike, truth: npt.ArrayLike, thresholds: Sequence[float] = THRESHOLDS
) -> dict[float, float]:
    """Temporal-IoU accuracy: percent of queries whose found span overlaps the true one by at least a
    threshold.

    Args:
        found: ``(N, 2)`` the best span of every query.
        truth: ``(N, 2)`` the annotated span of every query.
        thresholds: the overlaps asked for.
    """
    overlap = temporal_iou(found, truth)
    if overlap.ndim != 1 or not len(overlap):
        raise InvalidInputError("found and truth must both be (N, 2) with at least one span")
    return {threshold: 100.0 * float((overlap >= threshold).mean()) for threshold in thresholds}


def _spans(values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    spans = np.asarray(values, dtype=np.float64)
    if spans.ndim < 1 or spans.shape[-1] != 2 or not (spans[..., 0] <= spans[..., 1]).all():
        raise InvalidInputError("a span is a pair of start and end, with the start first")
    return spans
