"""Models for WebAssembly: weights in 8-bit blocks are decoded once, when a model is opened, not in every run.

onnxruntime multiplies by blocks (``MatMulNBits``) as they are only on processors that it has kernels for; in
WebAssembly it decodes them each time, which takes half of a text's milliseconds. Written out as operators on constants,
the decoding is done by onnxruntime's own folding at the start. The file keeps its size, and the numbers are the same.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from motionrt.models.protobuf import fields, message, number, text

_GRAPH, _NODE, _INITIALIZER = 7, 1, 5  # of ModelProto and GraphProto in onnx.proto3
_FLOAT, _INT64 = 1, 7
_ZERO = "blocks/zero"


def unfolded(model: bytes, *, exact: bool = False) -> bytes:
    """An ONNX model without ``MatMulNBits`` of 8 bits; others, and all else, stay byte by byte.

    ``exact`` also decodes the weights of products of 8-bit numbers, so that activations are float32: nothing is rounded
    in runs any more, and where two processors differ in the last digit, results do.
    """
    parts = (message(_GRAPH, _graph(one.content, exact)) if one.number == _GRAPH else one.raw for one in fields(model))
    return b"".join(parts)


@dataclass(frozen=True)
class _Node:
    """A node: its kind, its name, the names of what it takes and gives, and its attributes as they are stored."""

    kind: str
    name: str
    inputs: list[str]
    output: str
    attributes: list[bytes]

    @classmethod
    def read(cls, content: bytes) -> _Node:
        told: dict[int, list[bytes]] = {1: [], 3: [b""], 5: []}
        for field in fields(content):
            told.setdefault(field.number, []).append(field.content)
        inputs, (output, *_) = ([name.decode() for name in told[field]] for field in (1, 2))
        return cls(told[4][0].decode(), told[3][-1].decode() + "/", inputs, output, told[5])


def _graph(graph: bytes, exact: bool) -> list[bytes]:
    parts: list[bytes] = []
    constants: list[list[bytes]] = []
    floats: dict[str, str] = {}  # names of quantised activations -> what they were made of
    replaced = False
    for field in fields(graph):
        nodes = None
        if field.number == _NODE:
            node = _Node.read(field.content)
            if node.kind == "DynamicQuantizeLinear":
                floats[node.output] = node.inputs[0]
            if node.kind == "MatMulNBits":
                nodes = _blocks(node, constants)
            elif exact:
                nodes = _columns(node, floats)
        replaced = replaced or nodes is not None
        parts += [bytes(field.raw)] if nodes is None else [message(_NODE, node) for node in nodes]
    return [*parts, *(message(_INITIALIZER, constant) for constant in constants)] if replaced else parts


def _blocks(node: _Node, constants: list[list[bytes]]) -> list[list[bytes]] | None:
    """The operators in place of a product by blocks, whose shapes go to ``constants``; None where it stays."""
    values = dict(map(_attribute, node.attributes))
    width, count, size = (values[key] for key in ("K", "N", "block_size"))
    activations, codes, scales, zeros, order, bias = (node.inputs + [""] * 6)[:6]
    if values["bits"] != 8 or width % size or zeros or order:
        return None
    name = node.name
    constants += [] if constants else [_tensor(_ZERO, _FLOAT, (), struct.pack("<f", 128))]
    constants += [_shape(f"{name}blocks", count, width // size, 1), _shape(f"{name}whole", count, width)]
    return [
        _operator("Cast", [codes], f"{name}codes", _whole("to", _FLOAT)),
        _operator("Sub", [f"{name}codes", _ZERO], f"{name}numbers"),
        _operator("Reshape", [scales, f"{name}blocks"], f"{name}scales"),
        _operator("Mul", [f"{name}numbers", f"{name}scales"], f"{name}decoded"),
        _operator("Reshape", [f"{name}decoded", f"{name}whole"], f"{name}rows"),
        _operator("Transpose", [f"{name}rows"], f"{name}weights"),
        *_product(name, activations, bias, node.output),
    ]


def _columns(node: _Node, floats: dict[str, str]) -> list[list[bytes]] | None:
    """The operators in place of a product of 8-bit numbers with a scale a column; None for anything else."""
    if node.kind == "DynamicQuantizeMatMul":
        activations, codes, scales, zeros, bias = (node.inputs + [""] * 2)[:5]
    elif node.kind == "MatMulIntegerToFloat" and node.inputs[0] in floats:
        _, codes, _, scales, _, zeros, bias = (node.inputs + [""] * 3)[:7]
        activations = floats[node.inputs[0]]
    else:
        return None
    name = node.name
    centred = [
        _operator("Cast", [zeros], f"{name}zeros", _whole("to", _FLOAT)),
        _operator("Sub", [f"{name}codes", f"{name}zeros"], f"{name}numbers"),
    ]
    return [
        _operator("Cast", [codes], f"{name}codes", _whole("to", _FLOAT)),
        *(centred if zeros else []),
        _operator("Mul", [f"{name}numbers" if zeros else f"{name}codes", scales], f"{name}weights"),
        *_product(name, activations, bias, node.output),
    ]


def _product(name: str, activations: str, bias: str, output: str) -> list[list[bytes]]:
    product = _operator("MatMul", [activations, f"{name}weights"], f"{name}product" if bias else output)
    return [product, _operator("Add", [f"{name}product", bias], output)] if bias else [product]


def _operator(kind: str, inputs: list[str], output: str, *attributes: bytes) -> list[bytes]:
    return [*(text(1, name) for name in inputs), text(2, output), text(3, output), text(4, kind), *attributes]


def _whole(name: str, value: int) -> bytes:
    """An attribute that is a whole number."""
    return message(5, [text(1, name), number(3, value), number(20, 2)])


def _shape(name: str, *sizes: int) -> list[bytes]:
    return _tensor(name, _INT64, (len(sizes),), struct.pack(f"<{len(sizes)}q", *sizes))


def _tensor(name: str, kind: int, sizes: tuple[int, ...], content: bytes) -> list[bytes]:
    return [*(number(1, size) for size in sizes), number(2, kind), text(8, name), message(9, [content])]


def _attribute(attribute: bytes) -> tuple[str, int]:
    """Name and whole number of an attribute."""
    told = {field.number: field for field in fields(attribute)}
    value = told[3].value if 3 in told else 0
    return told[1].content.decode(), value if isinstance(value, int) else 0
