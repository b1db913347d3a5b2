"""Moving outliers from the activations into the weights, so that 8 bits are enough (SmoothQuant, 2023).

The factors are powers of two, in quarters: noise in the calibration does not change them. With whole powers,
activations of the sentence encoder's feed-forward are up to 40 % less exact.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

import numpy as np
import onnx
import onnxruntime as ort
from onnx import NodeProto, TensorProto, helper

from motionrt_export.rewrite import Weights, replace, weight_products

Feeds = Mapping[str, np.ndarray]

PARTS = 4
"""Factors between a power of two and the next."""


def smooth(model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds], *, alpha: float) -> None:
    """In every named product x @ W, divide channel j of x by s_j and multiply row j of W by it (eq. 4).

    s_j = max|x_j|^alpha / max|W_j|^(1 - alpha), to the nearest quarter of a power of two.
    """
    peaks = input_peaks(model, nodes, calibration)
    weights = Weights(model)

    def change(node: NodeProto) -> list[NodeProto] | None:
        if node.name not in nodes:
            return None
        return _smoothed(node, weights, peaks[node.input[0]], alpha)

    replace(model, change)


def _smoothed(node: NodeProto, weights: Weights, peak: np.ndarray, alpha: float) -> list[NodeProto]:
    x, weight = node.input
    matrix = weights.get(weight)  # (in, out)
    rows = np.maximum(np.abs(matrix).max(axis=1), 1e-5)
    exponent = alpha * np.log2(np.maximum(peak, 1e-5)) - (1.0 - alpha) * np.log2(rows)
    factors = np.exp2(np.rint(PARTS * exponent.astype(np.float64)) / PARTS)
    weights.add(weight, (matrix * factors[:, None]).astype(np.float32))
    factor = weights.add(f"{node.name}.smooth", (1.0 / factors).astype(np.float32))
    scaled = f"{node.name}.smoothed"
    node.input[0] = scaled
    return [helper.make_node("Mul", [x, factor], [scaled], name=f"{node.name}.smoothing"), node]


def input_peaks(model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds]) -> dict[str, np.ndarray]:
    """Largest magnitude of every channel of the inputs of the named products, over all of `calibration`."""
    peaks: dict[str, np.ndarray] = {}
    for found in inputs(model, nodes, calibration):
        for name, rows in found.items():
            peak = np.abs(rows).max(axis=0)
            peaks[name] = np.maximum(peaks.get(name, peak), peak)
    return peaks


def inputs(
    model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds]
) -> Iterator[dict[str, np.ndarray]]:
    """Rows (N, in) of the inputs of the named products by name, one feed of `calibration` after the other."""
    names = sorted({node.input[0] for node in weight_products(model) if node.name in nodes})
    session = _probe(model, names)
    for feeds in calibration if names else ():
        values = session.run(names, dict(feeds))
        yield {name: value.reshape(-1, value.shape[-1]) for name, value in zip(names, values, strict=True)}


def _probe(model: onnx.ModelProto, names: list[str]) -> ort.InferenceSession:
    probe = onnx.ModelProto.FromString(model.SerializeToString())
    probe.graph.output.extend(helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in names)
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads = 1, 1
    return ort.InferenceSession(probe.SerializeToString(), options, providers=["CPUExecutionProvider"])
