"""How far two outputs are apart, over what the mask calls valid."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]
Figures = dict[str, dict[str, float]]  # output -> measure -> worst value


def measure(found: Array, expected: Array, valid: Array | None = None, scale: Array | None = None) -> dict[str, float]:
    """`cosine_min` over rows, `max_abs_error` and `rms_error`.

    Args:
        found: (B, ..., D) float32.
        expected: the same shape.
        valid: (B, T) bool for outputs (B, T, D), which rows count; None: all.
        scale: (D,) what errors are divided by, such as the standard deviation of every feature; None: 1.
    """
    rows, wanted = (array[valid] if valid is not None else array for array in (found, expected))
    rows, wanted = (array.reshape(-1, array.shape[-1]).astype(np.float64) for array in (rows, wanted))
    error = (rows - wanted) / (1.0 if scale is None else scale)
    lengths = np.linalg.norm(rows, axis=-1) * np.linalg.norm(wanted, axis=-1)
    cosine = (rows * wanted).sum(axis=-1) / np.maximum(lengths, 1e-30)
    return {
        "cosine_min": float(cosine.min()),
        "max_abs_error": float(np.abs(error).max()),
        "rms_error": float(np.sqrt((error**2).mean())),
    }


def worst(many: Iterable[Mapping[str, Mapping[str, float]]]) -> Figures:
    """The worst value of every measure of every output."""
    result: Figures = {}
    for figures in many:
        for output, values in figures.items():
            kept = result.setdefault(output, {})
            for name, value in values.items():
                kept[name] = _worse(name, value, kept.get(name, value))
    return result


def beyond(figures: Mapping[str, Mapping[str, float]], tolerance: Mapping[str, Mapping[str, float]]) -> list[str]:
    """What breaks the tolerance, in words."""
    broken = []
    for output, limits in tolerance.items():
        for name, limit in limits.items():
            value = figures[output][name]
            if math.isnan(value) or _worse(name, value, limit) != limit:
                relation = "at least" if name.endswith("_min") else "at most"
                broken.append(f"{output}: {name} is {value:.6g}, must be {relation} {limit:g}")
    return broken


def rounded(figures: Mapping[str, Mapping[str, float]]) -> Figures:
    """For the manifest: cosines rounded down to 4 places, ratios up to 3, errors up to 2 digits."""
    return {
        output: {name: _rounded(name, value) for name, value in values.items()} for output, values in figures.items()
    }


def _worse(name: str, a: float, b: float) -> float:
    return min(a, b) if name.endswith("_min") else max(a, b)


def _rounded(name: str, value: float) -> float:
    if name.endswith("_min"):
        return math.floor(value * 1e4) / 1e4
    if name.endswith("_ratio"):
        return math.ceil(value * 1e3) / 1e3
    if value == 0.0:
        return 0.0
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / step) * step:.2g}")
