"""Weights stored as float16 and computed in float32: half the size wherever integers are slow or too coarse.

Nothing is computed in float16. A Cast widens every weight; onnxruntime folds it when the session opens, so that a call
costs what it costs with float32. Rows of a lookup table are widened after they were looked up, and the table stays
small in memory, too.
"""

from __future__ import annotations

import numpy as np
import onnx
from onnx import NodeProto, TensorProto, helper

from motionrt_export.rewrite import Weights, drop_unused, replace

MIN_SIZE = 1024  # numbers of a matrix; statistics, biases and norms stay as they are
LARGEST = 60_000.0  # float16 ends at 65,504
DESCRIPTION = "weights stored as float16, computed in float32; statistics, biases and norms: float32"


def halve(model: onnx.ModelProto) -> onnx.ModelProto:
    """A copy of a float32 graph with its large weights as float16."""
    copy: onnx.ModelProto = onnx.ModelProto.FromString(model.SerializeToString())
    weights = Weights(copy)
    halved = {name: weights.get(name) for name, tensor in weights.tensors.items() if _fits(tensor, weights)}
    widened: set[str] = set()

    def change(node: NodeProto) -> list[NodeProto] | None:
        found = [name for name in node.input if name in halved]
        if not found:
            return None
        if node.op_type == "Gather" and node.input[0] in halved:
            return _narrow_lookup(node, weights, halved[node.input[0]])
        new = [_widen(name, weights, halved[name]) for name in dict.fromkeys(found) if name not in widened]
        widened.update(found)
        node.input[:] = [_wide(name) if name in halved else name for name in node.input]
        return [*new, node]

    replace(copy, change)
    drop_unused(copy)
    return copy


def _fits(tensor: TensorProto, weights: Weights) -> bool:
    """Whether a weight is large enough to matter, and all of it can be a float16."""
    if tensor.data_type != TensorProto.FLOAT or len(tensor.dims) < 2 or int(np.prod(tensor.dims)) < MIN_SIZE:
        return False
    return float(np.abs(weights.get(tensor.name)).max()) <= LARGEST


def _narrow(name: str, weights: Weights, value: np.ndarray) -> str:
    return weights.add(f"{name}.float16", value.astype(np.float16))


def _wide(name: str) -> str:
    return f"{name}.float32"


def _widen(name: str, weights: Weights, value: np.ndarray) -> NodeProto:
    stored = _narrow(name, weights, value)
    return helper.make_node("Cast", [stored], [_wide(name)], name=f"{name}.widen", to=TensorProto.FLOAT)


def _narrow_lookup(node: NodeProto, weights: Weights, table: np.ndarray) -> list[NodeProto]:
    stored, result = _narrow(node.input[0], weights, table), node.output[0]
    rows = NodeProto.FromString(node.SerializeToString())
    rows.input[0], rows.output[0] = stored, f"{result}.float16"
    widen = helper.make_node("Cast", [rows.output[0]], [result], name=f"{node.name}.widen", to=TensorProto.FLOAT)
    return [rows, widen]
