"""Attention as one operator of onnxruntime instead of eleven: the same numbers, 4 % of a text query less."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import onnx
from onnx import NodeProto, TensorProto, helper

from motionrt_export.rewrite import MICROSOFT, Weights, drop_unused, import_microsoft, replace


@dataclass(frozen=True)
class Found:
    """One attention: `joint` holds queries, keys and values (B, T, 3 * heads * width), `valid` is (B, T) bool."""

    joint: str
    valid: str
    heads: int
    width: int
    scale: float
    result: str


def join_attention(model: onnx.ModelProto) -> None:
    """Turn every attention of `layers.Attention` among all tokens, with a mask of keys, into MultiHeadAttention."""
    graph = Links(model)
    found = {one.result: one for node in model.graph.node if (one := graph.attention(node)) is not None}
    weights, masks = Weights(model), set[str]()

    def change(node: NodeProto) -> list[NodeProto] | None:
        one = found.get(node.output[0])
        return None if one is None else _joined(one, weights, masks)

    replace(model, change)
    drop_unused(model)
    if found:
        import_microsoft(model)


def _joined(one: Found, weights: Weights, masks: set[str]) -> list[NodeProto]:
    wide = one.heads * one.width
    sizes = weights.add(f"sizes.{wide}", np.array([wide] * 3, np.int64))
    parts, shown = [f"{one.result}.{part}" for part in ("q", "k", "v")], f"{one.valid}.shown"
    attributes = {"num_heads": one.heads, "scale": one.scale, "domain": MICROSOFT}
    new = [
        helper.make_node("Split", [one.joint, sizes], parts, name=f"{one.result}.split", axis=2),
        helper.make_node(
            "MultiHeadAttention", [*parts, "", shown], [one.result], name=f"{one.result}.attention", **attributes
        ),
    ]
    if shown in masks:
        return new
    masks.add(shown)
    return [helper.make_node("Cast", [one.valid], [shown], name=shown, to=TensorProto.INT32), *new]


class Links:
    """Who makes a tensor, and who reads it."""

    def __init__(self, model: onnx.ModelProto) -> None:
        self.weights = Weights(model)
        self.makers = {output: node for node in model.graph.node for output in node.output}
        self.readers: dict[str, list[NodeProto]] = {}
        for node in model.graph.node:
            for name in node.input:
                self.readers.setdefault(name, []).append(node)

    def up(self, name: str, *kinds: str) -> NodeProto | None:
        """The last of the operators `kinds` on the way up from a tensor, through first inputs; None if others are."""
        node = None
        for kind in kinds:
            node = self.makers.get(name)
            if node is None or node.op_type != kind:
                return None
            name = node.input[0]
        return node

    def down(self, node: NodeProto, *kinds: str) -> NodeProto | None:
        """The same downwards, where nobody else reads what is between."""
        for kind in kinds:
            readers = self.readers.get(node.output[0], [])
            if len(readers) != 1 or readers[0].op_type != kind:
                return None
            node = readers[0]
        return node

    def attention(self, softmax: NodeProto) -> Found | None:
        """The attention around a softmax, as `layers.Attention` writes it; None for anything else."""
        if softmax.op_type != "Softmax" or (end := self.down(softmax, "MatMul", "Transpose", "Reshape")) is None:
            return None
        add = self.up(softmax.input[0], "Add")
        product = None if add is None else self.up(add.input[0], "MatMul")
        if add is None or product is None or (hidden := self._not(add.input[1])) is None:
            return None
        query, scale = self._scaled(product.input[0])
        split = self.up(product.input[1], "Transpose", "Split")
        if split is None or query != split.output[0] or self._value(softmax) != split.output[-1]:
            return None
        shaped = self.up(split.input[0], "Transpose", "Reshape")
        if len(split.output) != 3 or shaped is None or len(sizes := self._sizes(shaped.input[1])) != 4:
            return None
        return Found(shaped.input[0], hidden.input[0], sizes[2] // 3, sizes[3], scale, end.output[0])

    def _not(self, bias: str) -> NodeProto | None:
        """Where the keys that nobody may see become a bias (B, 1, 1, T)."""
        return self.up(bias, "Unsqueeze", "Unsqueeze", "Mul", "Cast", "Not")

    def _value(self, softmax: NodeProto) -> str:
        return str(self.readers[softmax.output[0]][0].input[1])

    def _scaled(self, query: str) -> tuple[str, float]:
        times = self.up(query, "Mul")
        if times is None or times.input[1] not in self.weights:
            return query, 1.0
        return times.input[0], float(self.weights.get(times.input[1]))

    def _sizes(self, name: str) -> list[int]:
        return [int(size) for size in self.weights.get(name)] if name in self.weights else []
