"""The vertices of a PLY file, ASCII or binary, as columns by name."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted.files import read_bytes
from motionrt.untrusted.words import shorten

Columns = dict[str, npt.NDArray[Any]]

_SIZES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
_BITS = {"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"}
_TYPES = _SIZES | _BITS | {"float": "f4", "double": "f8", "float32": "f4", "float64": "f8"}
_PROPERTIES = 256
_ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass(frozen=True)
class _Header:
    format: str
    vertices: int
    properties: tuple[tuple[str, str], ...]  # (name, NumPy type) of a vertex
    comments: tuple[str, ...]
    body: int  # offset of the first byte behind it
    lines: int


def read_ply(path: str | Path) -> tuple[Columns, tuple[str, ...]]:
    """Vertex properties ``{name: (N,)}`` and the comments of a PLY file.

    Raises:
        FormatError: no PLY, an unknown type, a list property of vertices, elements before the vertices, a short file.
    """
    path = Path(path)
    content = read_bytes(path, lambda reason, line: FormatError(path, reason, line))
    header = _header(path, content)
    if header.vertices > min(limits().cloud_points, len(content)):
        raise FormatError(path, f"claims {header.vertices:,} points; {how_to_raise('cloud_points')}")
    types = np.dtype([(name, _ORDERS[header.format] + kind) for name, kind in header.properties])
    if header.format == "ascii":
        rows = _ascii(path, content, header)
        return {name: _cast(rows[:, i], kind) for i, (name, kind) in enumerate(header.properties)}, header.comments
    if len(content) - header.body < header.vertices * types.itemsize:
        raise FormatError(path, f"ends before its {header.vertices} vertices do")
    table = np.frombuffer(content, types, header.vertices, header.body)
    return {name: table[name].astype(types[name].newbyteorder("=")) for name, _ in header.properties}, header.comments


def _header(path: Path, content: bytes) -> _Header:
    end = content.find(b"end_header")
    body = content.find(b"\n", end) + 1
    if not content.startswith(b"ply") or end < 0 or not body:
        raise FormatError(path, "is no PLY file: expected 'ply' at its start and an 'end_header' line", 1)
    lines = content[:end].decode("ascii", errors="replace").splitlines()
    words = [(number, line.split()) for number, line in enumerate(lines, start=1) if line.split()]
    kind = next((row[1] for _, row in words if row[0] == "format" and len(row) > 1), "")
    if kind not in _ORDERS:
        raise FormatError(path, f"format '{shorten(kind)}' is none of {', '.join(_ORDERS)}", 2)
    vertices, properties = _vertices(path, words)
    comments = tuple(" ".join(row[1:]) for _, row in words if row[0] == "comment")
    return _Header(kind, vertices, properties, comments, body, len(lines) + 1)


def _vertices(path: Path, words: list[tuple[int, list[str]]]) -> tuple[int, tuple[tuple[str, str], ...]]:
    elements = [i for i, (_, row) in enumerate(words) if row[0] == "element"]
    if not elements or words[elements[0]][1][1:2] != ["vertex"]:
        raise FormatError(path, "its first element must be 'vertex'")
    last = elements[1] if len(elements) > 1 else len(words)
    count = words[elements[0]][1][-1]
    rows = [(line, row) for line, row in words[elements[0] + 1 : last] if row[0] == "property"]
    if not (count.isascii() and count.isdigit() and len(count) < 20):
        raise FormatError(path, f"the number of vertices is '{shorten(count)}'", words[elements[0]][0])
    properties = tuple(_property(path, line, row) for line, row in rows)
    names = [name for name, _ in properties]
    if not names or len(names) > _PROPERTIES or len(set(names)) < len(names):
        raise FormatError(path, f"needs different properties of a vertex, found: {shorten(', '.join(names))}")
    return int(count), properties


def _property(path: Path, line: int, row: list[str]) -> tuple[str, str]:
    if len(row) != 3 or row[1] not in _TYPES:
        raise FormatError(path, f"'{shorten(' '.join(row))}' is not a plain property of a known type", line)
    return row[2], _TYPES[row[1]]


def _ascii(path: Path, content: bytes, header: _Header) -> npt.NDArray[np.float64]:
    lines = content[header.body :].decode("ascii", errors="replace").splitlines()[: header.vertices]
    if len(lines) < header.vertices:
        raise FormatError(path, f"ends before its {header.vertices} vertices do")
    rows = np.empty((header.vertices, len(header.properties)))
    for number, line in enumerate(lines):
        try:
            rows[number] = [float(word) for word in line.split()]
        except ValueError:
            place = header.lines + number + 1
            expected = f"expected {len(header.properties)} numbers"
            raise FormatError(path, f"{expected}, found '{shorten(line)}'", place) from None
    return rows


def _cast(column: npt.NDArray[np.float64], kind: str) -> npt.NDArray[Any]:
    """Numbers as the header's type has them; what does not fit is clipped, as no label or place is that large."""
    if kind[0] == "f":
        with np.errstate(over="ignore"):
            return column.astype(kind)
    bounds = np.iinfo(kind)
    return np.clip(np.nan_to_num(column), bounds.min, bounds.max).astype(kind)
