"""Windows as PostgreSQL's binary COPY takes them: a database reads them ten times as fast as numbers in words.

The stream is a header, for every row the number of its fields and each field as its length and bytes, and a trailer;
all numbers are big-endian (PostgreSQL's documentation, "COPY", file formats, binary format).
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from motionrt.engines.rows import Row
from motionrt.motion.skeleton import FloatArray

COLUMNS = "clip, part, start_s, end_s, duration_s, text, tags, embedding, attributes, file, size, mtime_ns"
_HEADER, _TRAILER = b"PGCOPY\n\xff\r\n\0" + struct.pack("!ii", 0, 0), struct.pack("!h", -1)
_FIELDS = struct.pack("!h", len(COLUMNS.split(",")))
_NULL = struct.pack("!i", -1)
_TEXT, _REAL = 25, 700  # the types' numbers, fixed in PostgreSQL
_AT_ONCE = 500  # rows of a piece


def stream(rows: Iterable[Row]) -> Iterator[bytes]:
    """The windows as a binary stream of :data:`COLUMNS`, in pieces."""
    piece = [_HEADER]
    for number, row in enumerate(rows, 1):
        piece.append(_row(row))
        if number % _AT_ONCE == 0:
            yield b"".join(piece)
            piece = []
    yield b"".join([*piece, _TRAILER])


def _row(row: Row) -> bytes:
    clip = row.clip
    return b"".join(
        (
            _FIELDS,
            _text(clip.id),
            struct.pack("!ii", 4, row.part),
            struct.pack("!id", 8, row.start_s),
            struct.pack("!id", 8, row.end_s),
            struct.pack("!id", 8, clip.duration_s),
            _text(clip.text),
            _sized(_texts(row.tags)),
            _sized(struct.pack("!hh", len(row.embedding), 0) + _floats(row.embedding)),
            _NULL if row.attributes is None else _sized(_reals(row.attributes)),
            _text(clip.file),
            struct.pack("!iq", 8, clip.size),
            struct.pack("!iq", 8, clip.mtime_ns),
        )
    )


def _sized(content: bytes) -> bytes:
    return struct.pack("!i", len(content)) + content


def _text(text: str | None) -> bytes:
    return _NULL if text is None else _sized(text.encode())


def _floats(numbers: FloatArray) -> bytes:
    return np.asarray(numbers, ">f4").tobytes()


def _texts(texts: Sequence[str]) -> bytes:
    """A one-dimensional array of texts, which counts from 1; an empty one has no dimension."""
    if not texts:
        return struct.pack("!iii", 0, 0, _TEXT)
    return struct.pack("!iiiii", 1, 0, _TEXT, len(texts), 1) + b"".join(map(_text, texts))


def _reals(numbers: FloatArray) -> bytes:
    """A one-dimensional array of real numbers: each is its length, 4, and itself."""
    if not len(numbers):
        return struct.pack("!iii", 0, 0, _REAL)
    items = np.empty(len(numbers), [("length", ">i4"), ("number", ">f4")])
    items["length"], items["number"] = 4, numbers
    return struct.pack("!iiiii", 1, 0, _REAL, len(numbers), 1) + items.tobytes()
