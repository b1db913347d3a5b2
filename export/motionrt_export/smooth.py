"""Moving outliers from the activations into the weights, so that 8 bits are enough (SmoothQuant, 2023).

The factors are powers of two: scaling rounds nothing, and noise in the calibration does not change them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

import numpy as np
import onnx
import onnxruntime as ort
from onnx import NodeProto, TensorProto, helper

from motionrt_export.rewrite import Weights, replace, weight_products

Feeds = Mapping[str, np.ndarray]


def smooth(model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds], *, alpha: float) -> None:
    """In every named product x @ W, divide channel j of x by s_j and multiply row j of W by it (eq. 4).

    s_j = max|x_j|^alpha / max|W_j|^(1 - alpha), to the nearest power of two.
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
    exponent = np.rint(alpha * np.log2(np.maximum(peak, 1e-5)) - (1.0 - alpha) * np.log2(rows))
    weights.add(weight, np.ldexp(matrix, exponent.astype(int)[:, None]).astype(np.float32))
    factor = weights.add(f"{node.name}.smooth", np.ldexp(np.float32(1.0), -exponent.astype(int)).astype(np.float32))
    scaled = f"{node.name}.smoothed"
    node.input[0] = scaled
    return [helper.make_node("Mul", [x, factor], [scaled], name=f"{node.name}.smoothing"), node]


def input_peaks(model: onnx.ModelProto, nodes: Collection[str], calibration: Iterable[Feeds]) -> dict[str, np.ndarray]:
    """Largest magnitude of every channel of the inputs of the named products, over all of `calibration`."""
    names = sorted({node.input[0] for node in weight_products(model) if node.name in nodes})
    session = _probe(model, names)
    peaks: dict[str, np.ndarray] = {}
    for feeds in calibration:
        for name, value in zip(names, session.run(names, dict(feeds)), strict=True):
            peak = np.abs(value).reshape(-1, value.shape[-1]).max(axis=0)
            peaks[name] = np.maximum(peaks.get(name, peak), peak)
    return peaks


def _probe(model: onnx.ModelProto, names: list[str]) -> ort.InferenceSession:
    probe = onnx.ModelProto.FromString(model.SerializeToString())
    probe.graph.output.extend(helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in names)
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads = 1, 1
    return ort.InferenceSession(probe.SerializeToString(), options, providers=["CPUExecutionProvider"])
