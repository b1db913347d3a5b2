"""ONNX models of one matrix product, written byte by byte: enough to ask onnxruntime how fast it multiplies.

The format is protocol buffers; the numbers of the fields are those of ``onnx.proto3``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FLOAT, UINT8, INT8, INT32 = 1, 2, 3, 6
_TYPES = {np.dtype(np.float32): FLOAT, np.dtype(np.int8): INT8, np.dtype(np.uint8): UINT8}
_OPSET, _IR_VERSION = 13, 8


def product_model(operator: str, rows: int, weight: npt.NDArray[Any], given: int, made: int) -> bytes:
    """A model with input ``a`` ``(rows, K)``, a constant ``b`` ``(K, N)`` and the output ``operator(a, b)``.

    Args:
        operator: ``MatMul`` or ``MatMulInteger``.
        rows: of the input.
        weight: the constant, float32, int8 or uint8.
        given: element type of the input.
        made: element type of the output.
    """
    depth, columns = weight.shape
    node = _text(1, "a") + _text(1, "b") + _text(2, "c") + _text(4, operator)
    tensor = b"".join(_number(1, size) for size in weight.shape)
    tensor += _number(2, _TYPES[weight.dtype]) + _text(8, "b") + _bytes(9, np.ascontiguousarray(weight).tobytes())
    graph = _bytes(1, node) + _text(2, "product") + _bytes(5, tensor)
    graph += _bytes(11, _value("a", given, rows, depth)) + _bytes(12, _value("c", made, rows, columns))
    return _number(1, _IR_VERSION) + _bytes(7, graph) + _bytes(8, _text(1, "") + _number(2, _OPSET))


def _value(name: str, kind: int, *shape: int) -> bytes:
    dimensions = b"".join(_bytes(1, _number(1, size)) for size in shape)
    return _text(1, name) + _bytes(2, _bytes(1, _number(1, kind) + _bytes(2, dimensions)))


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3) + _varint(value)


def _text(field: int, value: str) -> bytes:
    return _bytes(field, value.encode("utf-8"))


def _bytes(field: int, value: bytes) -> bytes:
    return _varint(field << 3 | 2) + _varint(len(value)) + value


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*out, value])
