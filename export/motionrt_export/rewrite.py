"""Small tools for changing an ONNX graph in place."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
import onnx
from onnx import NodeProto, helper, numpy_helper

MICROSOFT = "com.microsoft"
"""The domain of the operators that onnxruntime adds."""


class Weights:
    """The initialisers of a graph by name, as arrays."""

    def __init__(self, model: onnx.ModelProto) -> None:
        self.graph = model.graph
        self.tensors = {tensor.name: tensor for tensor in model.graph.initializer}

    def __contains__(self, name: str) -> bool:
        return name in self.tensors

    def shape(self, name: str) -> tuple[int, ...]:
        """The shape of a stored tensor."""
        return tuple(self.tensors[name].dims)

    def get(self, name: str) -> np.ndarray:
        """A stored tensor as an array."""
        return numpy_helper.to_array(self.tensors[name])

    def add(self, name: str, value: np.ndarray) -> str:
        """Store `value` under `name`, replacing what was there; gives the name back."""
        if name in self.tensors:
            self.tensors[name].CopyFrom(numpy_helper.from_array(value, name))
        else:
            self.graph.initializer.append(numpy_helper.from_array(value, name))
            self.tensors[name] = self.graph.initializer[-1]
        return name


def replace(model: onnx.ModelProto, change: Callable[[NodeProto], Iterable[NodeProto] | None]) -> None:
    """Ask `change` for every node: None keeps it, else the nodes that take its place (may include it)."""
    nodes: list[NodeProto] = []
    for node in model.graph.node:
        new = change(node)
        nodes.extend([node] if new is None else new)
    copies = [NodeProto.FromString(node.SerializeToString(deterministic=True)) for node in nodes]
    del model.graph.node[:]
    model.graph.node.extend(copies)


def drop_unused(model: onnx.ModelProto) -> None:
    """Remove initialisers that no node reads, and nodes whose outputs nobody reads."""
    wanted = {output.name for output in model.graph.output}
    kept: list[NodeProto] = []
    for node in reversed(list(model.graph.node)):
        if any(output in wanted for output in node.output):
            kept.append(NodeProto.FromString(node.SerializeToString(deterministic=True)))
            wanted.update(node.input)
    del model.graph.node[:]
    model.graph.node.extend(reversed(kept))
    tensors = [tensor for tensor in model.graph.initializer if tensor.name in wanted]
    if len(tensors) != len(model.graph.initializer):
        copies = [onnx.TensorProto.FromString(tensor.SerializeToString()) for tensor in tensors]
        del model.graph.initializer[:]
        model.graph.initializer.extend(copies)


def weight_products(model: onnx.ModelProto) -> list[NodeProto]:
    """The MatMul nodes whose second operand is a stored (in, out) matrix, in graph order."""
    weights = Weights(model)
    return [
        node
        for node in model.graph.node
        if node.op_type == "MatMul" and node.input[1] in weights and len(weights.shape(node.input[1])) == 2
    ]


def import_microsoft(model: onnx.ModelProto) -> None:
    """Let a graph use the operators of onnxruntime."""
    if all(opset.domain != MICROSOFT for opset in model.opset_import):
        model.opset_import.append(helper.make_opsetid(MICROSOFT, 1))
