"""Fewer operators, same numbers: constants become stored tensors, shapes that repeat the batch are fixed."""

from __future__ import annotations

import numpy as np
import onnx
from onnx import NodeProto, numpy_helper

from motionrt_export.rewrite import Weights, drop_unused, replace


def simplify(model: onnx.ModelProto) -> None:
    """Clean up after the exporter."""
    store_constants(model)
    fix_reshapes(model)
    drop_unused(model)


def store_constants(model: onnx.ModelProto) -> None:
    """Constant operators -> initialisers."""
    weights = Weights(model)

    def change(node: NodeProto) -> list[NodeProto] | None:
        if node.op_type != "Constant" or node.attribute[0].name != "value":
            return None
        weights.add(node.output[0], numpy_helper.to_array(node.attribute[0].t))
        return []

    replace(model, change)


def fix_reshapes(model: onnx.ModelProto) -> None:
    """A Reshape to (batch, ...) with the rest known needs no arithmetic on shapes: 0 keeps the first axis.

    Every tensor of these graphs that is reshaped has the batch in front, so the computed first size is
    that of the tensor itself; what cannot be read as a constant is left alone.
    """
    weights = Weights(model)
    makers = {output: node for node in model.graph.node for output in node.output}

    def change(node: NodeProto) -> list[NodeProto] | None:
        if node.op_type != "Reshape" or (sizes := _sizes(node.input[1], makers, weights)) is None:
            return None
        node.input[1] = weights.add(f"{node.name}.sizes", np.array(sizes, np.int64))
        return [node]

    replace(model, change)


def _sizes(shape: str, makers: dict[str, NodeProto], weights: Weights) -> list[int] | None:
    """[0, constants...] for a Concat of the batch size and constants, with at most one -1; else None."""
    maker = makers.get(shape)
    if maker is None or maker.op_type != "Concat" or not _is_first_size(maker.input[0], makers, weights):
        return None
    rest = [_constant(name, makers, weights) for name in maker.input[1:]]
    return None if None in rest else [0, *(size for size in rest if size is not None)]


def _constant(name: str, makers: dict[str, NodeProto], weights: Weights) -> int | None:
    """The number that `name` holds, seen through an Unsqueeze; None when it is computed."""
    if name not in weights and name in makers and makers[name].op_type == "Unsqueeze":
        name = makers[name].input[0]
    return int(weights.get(name).item()) if name in weights else None


def _is_first_size(name: str, makers: dict[str, NodeProto], weights: Weights) -> bool:
    """Whether `name` is element 0 of the shape of a tensor, as Shape -> Gather(0) -> Unsqueeze."""
    expected = ("Unsqueeze", "Gather", "Shape")
    for kind in expected:
        node = makers.get(name)
        if node is None or node.op_type != kind:
            return False
        if kind == "Gather" and (node.input[1] not in weights or weights.get(node.input[1]).item() != 0):
            return False
        name = node.input[0]
    return True
