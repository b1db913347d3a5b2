"""Outputs that are computed only when they are wanted: what leads to them alone becomes a branch of the graph."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TypeVar

import numpy as np
import onnx
from onnx import GraphProto, NodeProto, TensorProto, ValueInfoProto, helper, numpy_helper

from motionrt_export.specs import GraphSpec

Message = TypeVar("Message", NodeProto, TensorProto, ValueInfoProto)


def with_switch(model: onnx.ModelProto, spec: GraphSpec) -> onnx.ModelProto:
    """The model with the switch that its signature asks for, or as it is."""
    return switched(model, spec.switch.name, spec.switch.outputs) if spec.switch else model


def switched(model: onnx.ModelProto, switch: str, outputs: Collection[str]) -> onnx.ModelProto:
    """A copy with one more input, the bool `switch`: where it is false, `outputs` come without rows.

    It has no default: onnxruntime warns of an initializer that is an input as well. onnxruntime computes a whole graph
    whatever outputs are fetched, except for a branch that is not taken.
    """
    result, graph = onnx.ModelProto(), model.graph
    result.CopyFrom(model)
    needed = _leading_to(graph, [output.name for output in graph.output if output.name not in outputs])
    wanted = [output for output in graph.output if output.name in outputs]
    kept, moved = _parted(graph.node, needed)
    read = {name for node in kept for name in node.input} | {output.name for output in graph.output}
    shared = [tensor for tensor in graph.initializer if tensor.name in read]
    own = [tensor for tensor in graph.initializer if tensor.name not in read]
    branches = {
        "then_branch": helper.make_graph(moved, f"{switch}.yes", [], wanted, own),
        "else_branch": _nothing(f"{switch}.no", wanted),
    }
    choose = helper.make_node("If", [switch], [output.name for output in wanted], name=switch, **branches)
    _set(result.graph.node, [*kept, choose])
    _set(result.graph.initializer, shared)
    result.graph.input.append(helper.make_tensor_value_info(switch, TensorProto.BOOL, []))
    return result


def _leading_to(graph: GraphProto, names: list[str]) -> set[str]:
    """All tensors that are computed on the way to those of these names, with themselves."""
    makers = {output: node for node in graph.node for output in node.output}
    found, left = set[str](), list(names)
    while left:
        name = left.pop()
        if name in makers and name not in found:
            found.update(makers[name].output)
            left.extend(makers[name].input)
    return found


def _parted(nodes: Iterable[NodeProto], needed: set[str]) -> tuple[list[NodeProto], list[NodeProto]]:
    """Those that make something that is needed, and the others."""
    kept, moved = list[NodeProto](), list[NodeProto]()
    for node in nodes:
        (kept if needed.intersection(node.output) else moved).append(node)
    return kept, moved


def _nothing(name: str, outputs: list[ValueInfoProto]) -> GraphProto:
    """A branch that gives every output (B, d) as (0, d)."""
    shapes = [(0, output.type.tensor_type.shape.dim[1].dim_value) for output in outputs]
    empty = [f"{output.name}.none" for output in outputs]
    nodes = [
        helper.make_node("Constant", [], [one], name=one, value=numpy_helper.from_array(np.zeros(shape, np.float32)))
        for one, shape in zip(empty, shapes, strict=True)
    ]
    values = [
        helper.make_tensor_value_info(one, TensorProto.FLOAT, shape) for one, shape in zip(empty, shapes, strict=True)
    ]
    return helper.make_graph(nodes, name, [], values)


def _set(field: object, messages: list[Message]) -> None:
    """Put `messages` into a repeated field, which they may come from."""
    copies = [type(message).FromString(message.SerializeToString(deterministic=True)) for message in messages]
    del field[:]  # type: ignore[attr-defined]
    field.extend(copies)  # type: ignore[attr-defined]
