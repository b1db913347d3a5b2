"""Protocol buffers, written byte by byte: enough for the few ONNX messages that the runtime makes without ``onnx``."""

from __future__ import annotations

from collections.abc import Sequence


def message(field: int, parts: Sequence[bytes]) -> bytes:
    """A field that holds other fields, or plain bytes."""
    content = b"".join(parts)
    return _varint(field << 3 | 2) + _varint(len(content)) + content


def text(field: int, value: str) -> bytes:
    """A string, UTF-8."""
    return message(field, [value.encode("utf-8")])


def number(field: int, value: int) -> bytes:
    """A whole number from 0."""
    return _varint(field << 3) + _varint(value)


def _varint(value: int) -> bytes:
    """Seven bits a byte, the lowest first."""
    digits = bytearray()
    while value > 127:
        digits.append(value & 127 | 128)
        value >>= 7
    return bytes([*digits, value])
