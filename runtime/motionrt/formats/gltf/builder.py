"""The growing binary block of a GLB file, and the accessors that describe what lies in it."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.formats.gltf.container import Json

ARRAY_BUFFER = 34962
"""The target of a buffer view with vertex attributes."""

_COMPONENTS = {"float32": 5126, "uint16": 5123, "uint8": 5121}
_TYPES = {(): "SCALAR", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}


class GlbBuilder:
    """Appends arrays to a document and its binary block; what is there already stays where it is.

    Args:
        document: the glTF JSON; changed in place.
        binary: the bytes of ``buffer``.
        buffer: index of the buffer that grows.
    """

    def __init__(self, document: Json, binary: bytes = b"", buffer: int = 0) -> None:
        self.document = document
        self.buffer = buffer
        self._parts = [binary]
        self._size = len(binary)

    def add(self, array: npt.NDArray[Any], *, target: int | None = None, bounds: bool = False) -> int:
        """Index of a new accessor of ``array`` ``(N,)``, ``(N, 3)``, ``(N, 4)`` or ``(N, 4, 4)``.

        Matrices are given as they are multiplied and stored column by column. ``bounds`` writes min and max.
        """
        stored = np.swapaxes(array, -1, -2) if array.ndim == 3 else array
        view = self._view(np.ascontiguousarray(stored).astype(stored.dtype.newbyteorder("<")).tobytes(), target)
        accessor: Json = {
            "bufferView": view,
            "componentType": _COMPONENTS[array.dtype.name],
            "count": len(array),
            "type": _TYPES[array.shape[1:]],
        }
        if bounds:
            accessor["min"] = np.atleast_1d(array.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(array.max(axis=0)).tolist()
        return _append(self.document, "accessors", accessor)

    def finish(self) -> bytes:
        """The whole block; the document's buffer gets its length."""
        self.document["buffers"][self.buffer]["byteLength"] = self._size
        return b"".join(self._parts)

    def _view(self, content: bytes, target: int | None) -> int:
        gap = -self._size % 4
        view: Json = {"buffer": self.buffer, "byteOffset": self._size + gap, "byteLength": len(content)}
        if target is not None:
            view["target"] = target
        self._parts += [b"\0" * gap, content]
        self._size += gap + len(content)
        return _append(self.document, "bufferViews", view)


def _append(document: Json, key: str, entry: Json) -> int:
    entries = document.setdefault(key, [])
    entries.append(entry)
    return len(entries) - 1
