"""8-bit weights, three ways: rows of lookup tables, blocks along the input axis, output channels."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fnmatch import fnmatchcase

import numpy as np
import onnx
from onnx import NodeProto, TensorProto, helper

from motionrt_export.gptq import Floats, rounded
from motionrt_export.rewrite import MICROSOFT, Weights, drop_unused, import_microsoft, replace, weight_products

LIMIT = 64
"""Largest int8 weight of a channel: CPUs without VNNI add two products in 16 bits; 2 * 255 * 64 fits."""


def int8_rows(model: onnx.ModelProto, *, min_rows: int = 1000) -> None:
    """Store big lookup tables as int8 rows with one float32 scale each."""
    weights = Weights(model)

    def change(node: NodeProto) -> list[NodeProto] | None:
        if node.op_type != "Gather" or node.input[0] not in weights:
            return None
        table = node.input[0]
        if len(weights.shape(table)) != 2 or weights.shape(table)[0] < min_rows:
            return None
        return _scaled_lookup(node, weights)

    replace(model, change)
    drop_unused(model)


def _scaled_lookup(node: NodeProto, weights: Weights) -> list[NodeProto]:
    table, ids = node.input
    values = weights.get(table)
    scale = np.maximum(np.abs(values).max(axis=1, keepdims=True), 1e-12) / 127.0
    rows = weights.add(f"{table}.int8", np.rint(values / scale).astype(np.int8))
    scales = weights.add(f"{table}.scale", scale.astype(np.float32))
    name = node.output[0]
    return [
        helper.make_node("Gather", [rows, ids], [f"{name}.int8"], name=f"{node.name}.rows"),
        helper.make_node("Gather", [scales, ids], [f"{name}.scale"], name=f"{node.name}.scales"),
        helper.make_node("Cast", [f"{name}.int8"], [f"{name}.float"], name=f"{node.name}.cast", to=TensorProto.FLOAT),
        helper.make_node("Mul", [f"{name}.float", f"{name}.scale"], [name], name=f"{node.name}.scaled"),
    ]


def blocks(model: onnx.ModelProto, nodes: Collection[str], *, block: int = 128) -> None:
    """Turn the named weight products into MatMulNBits: symmetric 8-bit blocks along the input axis.

    Accuracy level 4 lets the runtime quantise the activations block by block: rows never disturb each other.
    """
    weights = Weights(model)

    def change(node: NodeProto) -> list[NodeProto] | None:
        return [_block_product(node, weights, block)] if node.name in nodes else None

    replace(model, change)
    drop_unused(model)
    import_microsoft(model)


def _block_product(node: NodeProto, weights: Weights, block: int) -> NodeProto:
    x, weight = node.input
    matrix = weights.get(weight).T  # (out, in)
    out, width = matrix.shape
    count = -(-width // block)
    parts = np.pad(matrix, ((0, 0), (0, count * block - width))).reshape(out, count, block)
    scale = np.maximum(np.abs(parts).max(axis=-1, keepdims=True), 1e-12) / 127.0
    packed = (np.rint(parts / scale) + 128.0).astype(np.uint8)
    names = [
        weights.add(f"{weight}.blocks", packed),
        weights.add(f"{weight}.scales", scale.astype(np.float32).reshape(-1)),
    ]
    sizes = {"K": width, "N": out, "bits": 8, "block_size": block, "accuracy_level": 4}
    return helper.make_node(
        "MatMulNBits", [x, *names], list(node.output), name=f"{node.name}.blocks", domain=MICROSOFT, **sizes
    )


def channels(model: onnx.ModelProto, nodes: Collection[str], products: Mapping[str, Floats] | None = None) -> None:
    """Turn the named weight products into integer ones: asymmetric 7 bits per output channel.

    Activations become uint8 per tensor when the graph runs; one quantisation serves all products of an input.
    Weights become the nearest whole numbers, or, where `products` has the input's, those with the nearest outputs
    (`gptq`).
    """
    weights = Weights(model)
    quantised: set[str] = set()

    def change(node: NodeProto) -> list[NodeProto] | None:
        if node.name not in nodes:
            return None
        return _channel_product(node, weights, quantised, (products or {}).get(node.input[0]))

    replace(model, change)
    drop_unused(model)


def _channel_product(
    node: NodeProto, weights: Weights, quantised: set[str], products: Floats | None
) -> list[NodeProto]:
    x, weight = node.input
    name, result = node.name, node.output[0]
    integers, scale, zero = _channel_weights(weights, weight, products)
    xq, xs, xz = (f"{x}.{part}" for part in ("uint8", "scale", "zero"))
    new = []
    if x not in quantised:
        quantised.add(x)
        new.append(helper.make_node("DynamicQuantizeLinear", [x], [xq, xs, xz], name=f"{name}.quantise"))
    return [
        *new,
        helper.make_node("MatMulInteger", [xq, integers, xz, zero], [f"{result}.int32"], name=f"{name}.int8"),
        helper.make_node("Cast", [f"{result}.int32"], [f"{result}.float"], name=f"{name}.cast", to=TensorProto.FLOAT),
        helper.make_node("Mul", [xs, scale], [f"{result}.scale"], name=f"{name}.scale"),
        helper.make_node("Mul", [f"{result}.float", f"{result}.scale"], [result], name=f"{name}.scaled"),
    ]


def _channel_weights(weights: Weights, weight: str, products: Floats | None) -> tuple[str, str, str]:
    names = f"{weight}.int8", f"{weight}.channel_scale", f"{weight}.channel_zero"
    if names[0] not in weights:
        matrix = weights.get(weight).astype(np.float64)  # (in, out)
        low, high = np.minimum(matrix.min(axis=0), 0.0), np.maximum(matrix.max(axis=0), 0.0)
        scale = np.maximum((high - low) / (2 * LIMIT), 1e-12)
        zero = np.rint(-LIMIT - low / scale)
        if products is None:
            whole = np.clip(np.rint(matrix / scale) + zero, -LIMIT, LIMIT)
        else:
            whole = rounded(matrix / scale + zero, products, -LIMIT, LIMIT)
        weights.add(names[0], whole.astype(np.int8))
        weights.add(names[1], scale.astype(np.float32))
        weights.add(names[2], zero.astype(np.int8))
    return names


def product_names(model: onnx.ModelProto, *contain: str) -> list[str]:
    """Names of the weight products whose name contains one of `contain` (all of them without).

    A `*` stands for anything, `[145]` for one of these, as in `/sentences/*/feed/down/`.
    """
    names = [node.name for node in weight_products(model)]
    return [name for name in names if not contain or any(fnmatchcase(name, f"*{part}*") for part in contain)]
