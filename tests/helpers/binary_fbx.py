"""Binary FBX 7.4 files, from the ASCII ones that :mod:`fbx_files` writes: nodes, their values, and where each ends."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass, field
from pathlib import Path

_TOKEN = re.compile(r'"[^"]*"|[{}:,]|[^\s{}:,"]+')
_NULL = bytes(13)
_ARRAYS = {"KeyTime": ("l", "q"), "KeyValueFloat": ("f", "f"), "KeyAttrFlags": ("i", "i"),
           "KeyAttrDataFloat": ("f", "f"), "KeyAttrRefCount": ("i", "i")}  # fmt: skip


@dataclass
class Node:
    """A name, its values (texts as they stand in quotes, numbers without), and the nodes inside it."""

    name: str
    values: list[str] = field(default_factory=list)
    inside: list[Node] = field(default_factory=list)


def write_binary_fbx(ascii_file: Path, path: Path) -> Path:
    """The same document as a binary file."""
    text = re.sub(r"^\s*;.*$", "", ascii_file.read_text(), flags=re.MULTILINE)
    tokens = _TOKEN.findall(text)
    roots, _ = _nodes(tokens, 0)
    out = bytearray(b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400))
    for root in roots:
        out += _packed(root, len(out))
    path.write_bytes(bytes(out) + _NULL)
    return path


def _nodes(tokens: list[str], at: int) -> tuple[list[Node], int]:
    found: list[Node] = []
    while at < len(tokens) and tokens[at] != "}":
        node, at = Node(tokens[at]), at + 2
        while at < len(tokens) and tokens[at] not in "{}" and not (at + 1 < len(tokens) and tokens[at + 1] == ":"):
            if tokens[at] != ",":
                node.values.append(tokens[at])
            at += 1
        if at < len(tokens) and tokens[at] == "{":
            node.inside, at = _nodes(tokens, at + 1)
            at += 1
        found.append(node)
    return found, at


def _packed(node: Node, at: int) -> bytes:
    array = _ARRAYS.get(node.name)
    if array and node.inside:  # "*12 { a: 1,2,3 }"
        values, inside = [_array(*array, node.inside[0].values)], []
    else:
        values, inside = [_value(value) for value in node.values], node.inside
    name, body = node.name.encode(), b"".join(values)
    at += 13 + len(name) + len(body)
    nested = b""
    for child in inside:
        nested += _packed(child, at + len(nested))
    nested += _NULL if inside else b""
    return struct.pack("<IIIB", at + len(nested), len(values), len(body), len(name)) + name + body + nested


def _array(kind: str, form: str, values: list[str]) -> bytes:
    numbers = [float(value) if form == "f" else int(value) for value in values]
    packed = struct.pack(f"<{len(numbers)}{form}", *numbers)
    return kind.encode() + struct.pack("<III", len(numbers), 0, len(packed)) + packed


def _value(value: str) -> bytes:
    if value.startswith('"'):
        text = value.strip('"')
        kind, _, name = text.partition("::")
        content = (f"{name}\0\x01{kind}" if "::" in text else text).encode()
        return b"S" + struct.pack("<I", len(content)) + content
    if re.fullmatch(r"-?\d+", value):
        return b"L" + struct.pack("<q", int(value))
    return b"D" + struct.pack("<d", float(value))
