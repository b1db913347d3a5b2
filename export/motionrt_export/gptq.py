"""Weights rounded one input channel after the other, each making up for the errors before it (GPTQ, 2023).

What counts is not the error of the weights, E (in, out), but that of the outputs on the calibration's inputs X, whose
square is tr(E' H E) with H = X' X. With H = U D U', U upper triangular with ones on its diagonal, it is the sum of
D_i |e_i + sum_{j < i} U_ji e_j|^2: row i is rounded such that it cancels that sum. This is what GPTQ does with the
Cholesky factor of the inverse (QuIP, 2023, theorem 6), without an inverse.

Sums are exact, or in one order: the number of threads changes no bit.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

import numpy as np
import numpy.typing as npt
import onnx

from motionrt_export.smooth import Feeds, inputs

Rows = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]

DAMPING = 0.01
"""What is added to the diagonal of H, as a share of its mean: directions that the calibration lacks count a little."""
BITS = 15
"""Of an activation in H: sums of up to 2^23 products of two are exact in float64."""
TOGETHER = 64
"""Output channels that are rounded at once: they stay in the cache."""


def input_products(model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds]) -> dict[str, Floats]:
    """H = X' X (in, in) of every input of the named products, over all of `calibration`."""
    rows: dict[str, list[Rows]] = {}
    for found in inputs(model, nodes, calibration):
        for name, some in found.items():
            rows.setdefault(name, []).append(some)
    return {name: _products(np.concatenate(parts).astype(np.float64)) for name, parts in rows.items()}


def _products(rows: Floats) -> Floats:
    """X' X of X (N, in) with `BITS` bits in every channel: steps are powers of two, and the sums exact."""
    step = np.exp2(np.ceil(np.log2(np.maximum(np.abs(rows).max(axis=0), 1e-12))) - BITS)
    whole = np.rint(rows / step)
    return np.asarray((whole.T @ whole) * step * step[:, None])


def rounded(target: Floats, products: Floats, low: float, high: float) -> Floats:
    """Whole numbers (in, out) from `low` to `high` that do for the inputs what `target` does.

    Args:
        target: (in, out) weights in steps of their output channel.
        products: (in, in) H, of the inputs that matter.
        low: the smallest whole number allowed.
        high: the largest.
    """
    order = np.argsort(-np.diag(products), kind="stable")  # what matters most first: the rest makes up for it
    feedback, result = _upper(products[np.ix_(order, order)]), np.empty_like(target)
    for start in range(0, target.shape[1], TOGETHER):
        some = slice(start, start + TOGETHER)
        result[order, some] = _rounded(target[order, some], feedback, low, high)
    return result


def _rounded(target: Floats, feedback: Floats, low: float, high: float) -> Floats:
    wanted, result = target.copy(), np.empty_like(target)
    for i, ups in enumerate(feedback):
        result[i] = np.clip(np.rint(wanted[i]), low, high)
        wanted[i + 1 :] += ups[i + 1 :, None] * (target[i] - result[i])
    return result


def _upper(products: Floats) -> Floats:
    """U of H + damping = U D U', column by column from the last, in elementwise steps."""
    left = products + DAMPING * max(float(np.diag(products).mean()), 1e-30) * np.eye(len(products))
    for i in reversed(range(len(left))):
        column = left[:i, i] / left[i, i]
        left[:i, :i] -= column[:, None] * left[:i, i]
        left[:i, i] = column
    return left
