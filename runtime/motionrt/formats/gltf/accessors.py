"""Arrays out of a GLB file, with every count and offset checked before a byte is touched."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.formats.gltf.container import Json
from motionrt.untrusted.files import read_bytes

_TYPES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_LARGEST = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}
_UNSIGNED = (5121, 5123, 5125)
NUMBER_LIMIT = 100_000_000
"""Numbers that are read from one file at most."""

_MESHOPT = ("EXT_meshopt_compression", "KHR_meshopt_compression")


class GlbArrays:
    """Reads accessors.

    Args:
        document: the glTF JSON.
        binary: the binary chunk.
        path: for messages.
    """

    def __init__(self, document: Json, binary: bytes, path: Path) -> None:
        self._document, self._binary, self._path = document, binary, path
        self._known: dict[int, npt.NDArray[np.float64]] = {}
        self._decoded: dict[int, bytes] = {}
        self._left = NUMBER_LIMIT

    def read(self, accessor: int, what: str) -> npt.NDArray[np.float64]:
        """Accessor as floats: ``(N,)``, ``(N, k)`` or ``(N, 4, 4)``; integers come as fractions.

        Raises:
            FormatError: compressed, outside of the file, or with numbers that are not finite; says ``what``.
        """
        if accessor not in self._known:
            self._known[accessor] = self._read(accessor, what)
        return self._known[accessor]

    def matrices(self, accessor: int, what: str) -> npt.NDArray[np.float64]:
        """Accessor of matrices ``(N, 4, 4)``; FormatError for any other."""
        values = self.read(accessor, what)
        if values.ndim != 3:
            raise self._error(f"{what} is not made of matrices: the file is damaged")
        return values

    def plain(self, accessor: int, what: str) -> npt.NDArray[np.float64]:
        """Accessor as floats; integers come as they are unless the file says that they are fractions."""
        entry = self._entry("accessors", accessor, what)
        as_fractions = self.read(accessor, what)
        most = _LARGEST.get(entry["componentType"], 1.0)
        return as_fractions if entry.get("normalized") else as_fractions * most

    def whole(self, accessor: int, what: str) -> npt.NDArray[np.int64]:
        """Accessor of whole numbers that are not negative, as indices are.

        Raises:
            FormatError: of another kind, or as :meth:`read`.
        """
        entry = self._entry("accessors", accessor, what)
        if entry.get("componentType") not in _UNSIGNED:
            raise self._error(f"{what} has indices of an unknown kind: the file is damaged")
        values = self.read(accessor, what) * _LARGEST.get(entry["componentType"], 1.0)
        return np.rint(values).astype(np.int64)

    def view(self, index: int, what: str) -> bytes:
        """The bytes of a buffer view."""
        view = self._entry("bufferViews", index, what)
        content, first, length = (
            self._buffer(view.get("buffer", 0), what),
            view.get("byteOffset", 0),
            view.get("byteLength", 0),
        )
        if not all(_whole(number) and number >= 0 for number in (first, length)) or first + length > len(content):
            raise self._error(f"{what} lies outside of the file's binary data: the file is damaged")
        return content[first : first + length]

    def count(self, accessor: int, what: str) -> int:
        """How many elements an accessor says it has."""
        count = self._entry("accessors", accessor, what).get("count")
        return count if isinstance(count, int) else 0

    def _read(self, accessor: int, what: str) -> npt.NDArray[np.float64]:
        entry = self._entry("accessors", accessor, what)
        width, component = _TYPES.get(entry.get("type", ""), 0), entry.get("componentType")
        count = entry["count"] if _whole(entry.get("count")) else 0
        if not width or component not in _COMPONENTS or count < 1:
            raise self._error(f"{what} has an accessor of an unknown kind")
        kind, sparse = np.dtype(_COMPONENTS[component]), "sparse" in entry
        rows = np.empty(0) if sparse else self._rows(entry, what, count, width, kind)
        self._left -= count * width
        if self._left < 0:
            raise self._error(f"its animation holds more than {NUMBER_LIMIT} numbers; cut it")
        rows = self._sparse(entry, what, count, width, kind) if sparse else rows
        values = rows.astype(np.float64)
        if component in _LARGEST:
            values = np.maximum(values / _LARGEST[component], -1.0)
        if not np.isfinite(values).all():
            raise self._error(f"{what} holds numbers that are not finite")
        return _shaped(values, width)

    def _sparse(self, entry: Json, what: str, count: int, width: int, kind: np.dtype[Any]) -> npt.NDArray[Any]:
        """Rows of which only some are stored, over others or zeros  [glTF 2.0, 3.6.2.3]."""
        sparse, inner = entry["sparse"], {5121: "<u1", 5123: "<u2", 5125: "<u4"}
        base = self._rows(entry, what, count, width, kind) if "bufferView" in entry else np.zeros((count, width), kind)
        some = sparse.get("count", 0) if isinstance(sparse, dict) else 0
        if not _whole(some) or not 0 < some <= count or sparse["indices"].get("componentType") not in inner:
            raise self._error(f"{what} is a sparse accessor of sizes that do not fit: the file is damaged")
        places = self._rows(sparse["indices"], what, some, 1, np.dtype(inner[sparse["indices"]["componentType"]]))
        if int(places.max()) >= count:
            raise self._error(f"{what} is a sparse accessor that points outside of itself: the file is damaged")
        out = base.copy()
        out[places[:, 0].astype(np.int64)] = self._rows(sparse["values"], what, some, width, kind)
        return out

    def _rows(self, entry: Json, what: str, count: int, width: int, kind: np.dtype[Any]) -> npt.NDArray[Any]:
        if "bufferView" not in entry:
            raise self._error(f"{what} has no data: it is compressed, or zeros; export without compression")
        view = self._entry("bufferViews", entry["bufferView"], what)
        if any(name in view.get("extensions", {}) for name in _MESHOPT):
            raise self._error(f"{what} is compressed with meshopt; export without compression")
        content = self._buffer(view.get("buffer", 0), what)
        size = width * kind.itemsize
        stride = view.get("byteStride", size)
        first, inside, length = view.get("byteOffset", 0), entry.get("byteOffset", 0), view.get("byteLength", 0)
        if not all(_whole(number) and number >= 0 for number in (stride, first, inside, length)):
            raise self._error(f"{what} has sizes that are no sizes: the file is damaged")
        start, end = first + inside, first + length
        if stride < size or start + stride * (count - 1) + size > min(end, len(content)):
            raise self._error(f"{what} lies outside of the file's binary data: the file is damaged")
        return np.ndarray((count, width), kind, content, start, (stride, kind.itemsize))

    def _buffer(self, index: int, what: str) -> bytes:
        if index not in self._decoded:
            self._decoded[index] = self._decode(index, what)
        return self._decoded[index]

    def _decode(self, index: int, what: str) -> bytes:
        uri = self._entry("buffers", index, what).get("uri")
        if uri is None:
            return self._binary if index == 0 else b""
        if isinstance(uri, str) and uri.startswith("data:") and ";base64," in uri[:100]:
            try:
                return base64.b64decode(uri.split(",", 1)[1], validate=True)
            except ValueError as error:  # binascii.Error is one
                raise self._error(f"the data of {what} is not base64: {error}") from error
        return self._beside(str(uri), what)

    def _beside(self, uri: str, what: str) -> bytes:
        """A buffer in a file in or below the folder of the document; nothing else is opened."""
        folder = self._path.resolve().parent
        place = (folder / unquote(uri).replace("\0", "?")).resolve()
        if "://" in uri or not place.is_relative_to(folder):
            raise self._error(f"{what} lies in another file ('{uri[:60]}'); save everything in one .glb")
        try:
            return read_bytes(place, lambda reason, _: self._error(f"its file '{uri[:60]}' {reason}"))
        except FileNotFoundError as error:
            raise self._error(f"{what} lies in '{uri[:60]}', which is not beside it; keep them together") from error

    def _entry(self, key: str, index: object, what: str) -> Json:
        entries = self._document.get(key, [])
        if not (_whole(index) and isinstance(index, int) and 0 <= index < len(entries)):
            raise self._error(f"{what} refers to {key}[{index}], which does not exist")
        entry: Json = entries[index]
        return entry

    def _error(self, reason: str) -> FormatError:
        return FormatError(self._path, reason)


def _shaped(values: npt.NDArray[np.float64], width: int) -> npt.NDArray[np.float64]:
    if width == 16:
        return np.swapaxes(values.reshape(-1, 4, 4), -1, -2)  # stored column by column
    return values[:, 0] if width == 1 else values


def _whole(number: object) -> bool:
    return isinstance(number, int) and not isinstance(number, bool)
