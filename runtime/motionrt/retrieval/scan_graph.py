"""The ONNX graph of a scan: one ``MatMulNBits`` of 8 or 4 bits, whose weights lie in memory and not in the model.

The runtime does not depend on ``onnx``; the few messages of the format that this one node needs are written here.
Field numbers are those of ``onnx.proto3``.
"""

from __future__ import annotations

from motionrt.models.protobuf import message, number, text

FLOAT, UINT8 = 1, 2
_INT_ATTRIBUTE, _EXTERNAL = 2, 1
_IR_VERSION, _OPSET, _CONTRIB = 8, 17, "com.microsoft"
_NOWHERE = "memory"  # the session is given the tensors themselves; the file of this name is never looked for


def scan_model(rows: int, width: int, bits: int = 8) -> bytes:
    """A model of ``query (1, width)`` -> ``scores (1, rows)``, float32.

    The session must be given the tensors ``codes`` ``(rows, 1, width)`` uint8, 128 standing for zero, or of 4 bits
    ``(rows, 1, width / 2)``, 8 standing for zero, and ``scales`` ``(rows,)`` float32. ``width`` is one block: a power
    of two from 16 to 256.
    """
    attributes = {"K": width, "N": rows, "bits": bits, "block_size": width, "accuracy_level": 4}
    node = [text(1, name) for name in ("query", "codes", "scales")]
    node += [text(2, "scores"), text(4, "MatMulNBits"), text(7, _CONTRIB)]
    node += [message(5, _attribute(name, value)) for name, value in attributes.items()]
    graph = [message(1, node), text(2, "scan")]
    graph += [
        message(5, _external("codes", UINT8, (rows, 1, width * bits // 8))),
        message(5, _external("scales", FLOAT, (rows,))),
    ]
    graph += [message(11, _value("query", (1, width))), message(12, _value("scores", (1, rows)))]
    opsets = [message(8, [text(1, ""), number(2, _OPSET)]), message(8, [text(1, _CONTRIB), number(2, 1)])]
    return b"".join([number(1, _IR_VERSION), message(7, graph), *opsets])


def _attribute(name: str, value: int) -> list[bytes]:
    return [text(1, name), number(3, value), number(20, _INT_ATTRIBUTE)]


def _external(name: str, kind: int, shape: tuple[int, ...]) -> list[bytes]:
    place = message(13, [text(1, "location"), text(2, _NOWHERE)])
    return [*(number(1, size) for size in shape), number(2, kind), text(8, name), place, number(14, _EXTERNAL)]


def _value(name: str, shape: tuple[int, ...]) -> list[bytes]:
    sizes = message(2, [message(1, [number(1, size)]) for size in shape])
    return [text(1, name), message(2, [message(1, [number(1, FLOAT), sizes])])]
