"""Protocol buffers, read and written byte by byte: enough for what the runtime does to ONNX without ``onnx``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5  # wire types


class Field(NamedTuple):
    """A field of a message: its number, its value, and all its bytes with key and length.

    The value is a whole number, or the bytes of all else.
    """

    number: int
    value: int | memoryview
    raw: memoryview

    @property
    def content(self) -> bytes:
        """The value as bytes; none for a whole number."""
        return b"" if isinstance(self.value, int) else bytes(self.value)


def fields(content: bytes | memoryview) -> Iterator[Field]:
    """Every field of a message, one after the other.

    Raises:
        ValueError, IndexError: the bytes are no message.
    """
    whole, at = memoryview(content), 0
    while at < len(whole):
        start = at
        key, at = _read_varint(whole, at)
        wire = key & 7
        if wire == _VARINT:
            value, at = _read_varint(whole, at)
            yield Field(key >> 3, value, whole[start:at])
            continue
        if wire == _BYTES:
            length, at = _read_varint(whole, at)
        elif wire in (_FIXED64, _FIXED32):
            length = 8 if wire == _FIXED64 else 4
        else:
            raise ValueError(f"wire type {wire}")
        if at + length > len(whole):
            raise ValueError("a field ends behind its message")
        yield Field(key >> 3, whole[at : at + length], whole[start : at + length])
        at += length


def _read_varint(content: memoryview, at: int) -> tuple[int, int]:
    """A number of seven bits a byte, the lowest first, and where it ends."""
    value = shift = 0
    while True:
        byte = content[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at
        if shift > 63:
            raise ValueError("a number of more than ten bytes")


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
