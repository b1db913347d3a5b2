"""The ONNX graph of a scan: one ``MatMulNBits``, 8 bit, whose weights lie in memory and not in the model.

The runtime does not depend on ``onnx``; the few messages of the format that this one node needs are written here.
Field numbers are those of ``onnx.proto3``.
"""

from __future__ import annotations

FLOAT, UINT8 = 1, 2
_INT_ATTRIBUTE, _EXTERNAL = 2, 1
_IR_VERSION, _OPSET, _CONTRIB = 8, 17, "com.microsoft"
_NOWHERE = "memory"  # the session is given the tensors themselves; the file of this name is never looked for


def scan_model(rows: int, width: int) -> bytes:
    """A model of ``query (1, width)`` -> ``scores (1, rows)``, float32.

    The session must be given the tensors ``codes`` ``(rows, 1, width)`` uint8, 128 standing for zero, and ``scales``
    ``(rows,)`` float32. ``width`` is one block: a power of two from 16 to 256.
    """
    attributes = {"K": width, "N": rows, "bits": 8, "block_size": width, "accuracy_level": 4}
    node = [_text(1, name) for name in ("query", "codes", "scales")]
    node += [_text(2, "scores"), _text(4, "MatMulNBits"), _text(7, _CONTRIB)]
    node += [_message(5, _attribute(name, value)) for name, value in attributes.items()]
    graph = [_message(1, node), _text(2, "scan")]
    graph += [
        _message(5, _external("codes", UINT8, (rows, 1, width))),
        _message(5, _external("scales", FLOAT, (rows,))),
    ]
    graph += [_message(11, _value("query", (1, width))), _message(12, _value("scores", (1, rows)))]
    opsets = [_message(8, [_text(1, ""), _number(2, _OPSET)]), _message(8, [_text(1, _CONTRIB), _number(2, 1)])]
    return b"".join([_number(1, _IR_VERSION), _message(7, graph), *opsets])


def _attribute(name: str, value: int) -> list[bytes]:
    return [_text(1, name), _number(3, value), _number(20, _INT_ATTRIBUTE)]


def _external(name: str, kind: int, shape: tuple[int, ...]) -> list[bytes]:
    place = _message(13, [_text(1, "location"), _text(2, _NOWHERE)])
    return [*(_number(1, size) for size in shape), _number(2, kind), _text(8, name), place, _number(14, _EXTERNAL)]


def _value(name: str, shape: tuple[int, ...]) -> list[bytes]:
    sizes = _message(2, [_message(1, [_number(1, size)]) for size in shape])
    return [_text(1, name), _message(2, [_message(1, [_number(1, FLOAT), sizes])])]


def _message(field: int, parts: list[bytes]) -> bytes:
    content = b"".join(parts)
    return _varint(field << 3 | 2) + _varint(len(content)) + content


def _text(field: int, text: str) -> bytes:
    return _message(field, [text.encode()])


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3) + _varint(value)


def _varint(value: int) -> bytes:
    """A whole number from 0, seven bits a byte, the lowest first."""
    digits = bytearray()
    while value > 127:
        digits.append(value & 127 | 128)
        value >>= 7
    return bytes([*digits, value])
