"""ONNX models of one matrix product, written byte by byte: enough to ask onnxruntime how fast it multiplies.

The format is protocol buffers; the numbers of the fields are those of ``onnx.proto3``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.models.protobuf import message, number, text

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
    node = text(1, "a") + text(1, "b") + text(2, "c") + text(4, operator)
    tensor = b"".join(number(1, size) for size in weight.shape)
    tensor += number(2, _TYPES[weight.dtype]) + text(8, "b") + message(9, [np.ascontiguousarray(weight).tobytes()])
    graph = message(1, [node]) + text(2, "product") + message(5, [tensor])
    graph += message(11, [_value("a", given, rows, depth)]) + message(12, [_value("c", made, rows, columns)])
    return number(1, _IR_VERSION) + message(7, [graph]) + message(8, [text(1, "") + number(2, _OPSET)])


def _value(name: str, kind: int, *shape: int) -> bytes:
    dimensions = b"".join(message(1, [number(1, size)]) for size in shape)
    return text(1, name) + message(2, [message(1, [number(1, kind) + message(2, [dimensions])])])
