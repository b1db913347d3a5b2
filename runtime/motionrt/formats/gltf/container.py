"""The GLB container: one JSON document and one block of bytes, in and out  [glTF 2.0, 4.4]."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any, BinaryIO

from motionrt.errors import FormatError
from motionrt.formats.gltf.structure import misshapen
from motionrt.formats.text import require_file
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import json_text

Json = dict[str, Any]

GLTF_SUFFIXES = (".glb", ".gltf", ".vrm", ".vrma")

_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942


def read_container(path: Path) -> tuple[Json, bytes]:
    """The JSON object and the binary chunk (empty if there is none) of a GLB or, by its content, a glTF text file.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: not a whole file of glTF 2, or larger than the limits above.
    """
    require_file(path)
    try:
        with path.open("rb") as file:
            return _read(file, path.stat().st_size, path)
    except OSError as error:
        raise FormatError(path, f"cannot be read: {error.strerror or error}") from error


def pack_container(document: Json, binary: bytes) -> bytes:
    """The bytes of a GLB file; ``binary`` becomes the buffer that has no ``uri``."""
    text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode("utf-8")
    chunks = _chunk(_JSON, text, b" ") + (_chunk(_BIN, binary, b"\0") if binary else b"")
    return struct.pack("<III", _MAGIC, 2, 12 + len(chunks)) + chunks


def pack_text(document: Json, binary: bytes) -> bytes:
    """The bytes of a glTF text file with its one buffer inside."""
    uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode("ascii")
    first = {**document["buffers"][0], "uri": uri, "byteLength": len(binary)}
    whole = {**document, "buffers": [first, *document["buffers"][1:]]}
    return json.dumps(whole, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode("utf-8")


def _chunk(kind: int, content: bytes, filler: bytes) -> bytes:
    content += filler * (-len(content) % 4)
    return struct.pack("<II", len(content), kind) + content


def _read(file: BinaryIO, size: int, path: Path) -> tuple[Json, bytes]:
    head = file.read(12)
    if head.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] == b"{":
        return _parse(head + _rest_of_text(file, size, path), path), b""
    if len(head) < 12 or struct.unpack("<I", head[:4])[0] != _MAGIC:
        raise FormatError(path, _not_glb(head))
    version, length = struct.unpack("<II", head[4:])
    if version != 2:
        raise FormatError(path, f"is GLB version {version}; only version 2 can be read")
    if length > size:
        raise FormatError(path, f"the file ends after {size} of its {length} bytes: the copy is not complete")
    kind, text = _next_chunk(file, 12, length, path, limits().json_bytes)
    if kind != _JSON:
        raise FormatError(path, "its first chunk is not JSON")
    at = 20 + len(text)
    binary = b""
    if at + 8 <= length:
        kind, block = _next_chunk(file, at, length, path, limits().file_bytes)
        binary = block if kind == _BIN else b""
    return _parse(text, path), binary


def _rest_of_text(file: BinaryIO, size: int, path: Path) -> bytes:
    if size > limits().json_bytes:
        raise FormatError(path, f"holds {size} bytes of JSON: {how_to_raise('json_bytes')}")
    return file.read()


def _next_chunk(file: BinaryIO, at: int, end: int, path: Path, limit: int) -> tuple[int, bytes]:
    head = file.read(8)
    if len(head) < 8:
        raise FormatError(path, "the file ends inside the header of a chunk")
    length, kind = struct.unpack("<II", head)
    if at + 8 + length > end:
        raise FormatError(path, f"a chunk of {length} bytes does not fit into the file: it is damaged")
    if length > limit:
        what = "JSON" if kind == _JSON else "binary data"
        name = "json_bytes" if kind == _JSON else "file_bytes"
        raise FormatError(path, f"holds {length:,} bytes of {what}: {how_to_raise(name)}")
    return kind, file.read(length)


def _parse(text: bytes, path: Path) -> Json:
    document = json_text.parse(text, lambda reason, _: FormatError(path, reason))
    if not isinstance(document, dict) or not isinstance(document.get("asset"), dict):
        raise FormatError(path, "its JSON is not a glTF document: it has no asset")
    if not str(document["asset"].get("version", "")).startswith("2."):
        raise FormatError(path, "is not glTF 2; save it again as glTF 2.0")
    if (place := misshapen(document)) is not None:
        raise FormatError(path, f"{place} is not as glTF has it: the file is damaged")
    return document


def _not_glb(head: bytes) -> str:
    if head.startswith(b"version http"):
        return "is a pointer of git LFS, not the file itself: fetch it with 'git lfs pull'"
    return "is not a GLB file nor glTF: it starts neither with 'glTF' nor with JSON"
