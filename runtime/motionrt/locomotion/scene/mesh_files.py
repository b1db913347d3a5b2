"""What is checked of a mesh file before a library parses it: what it claims to hold, and which files it may name."""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

from motionrt.errors import SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted.files import read_bytes

_HEAD = 64 * 1024
_ELEMENT = re.compile(rb"^element[ \t]+(\w+)[ \t]+(\d{1,30})", re.MULTILINE)
_DIGITS = 30
_LEAST = 2  # bytes of a vertex or a face, one number and what parts it from the next


def check_claims(path: Path) -> None:
    """SceneError for a file whose header claims more vertices or faces than it has room for."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_HEAD)
    counts = {".ply": _ply_counts, ".off": _off_counts}.get(path.suffix.lower(), _no_counts)(head)
    if any(count * _LEAST > size or count > 3 * limits().triangles for count in counts):
        most = max(counts)
        raise SceneError(f"{path} claims to hold {most:,} elements in {size:,} bytes; {how_to_raise('triangles')}")


def _ply_counts(head: bytes) -> list[int]:
    return [int(count) for _, count in _ELEMENT.findall(head.partition(b"end_header")[0])]


def _off_counts(head: bytes) -> list[int]:
    lines = (line.partition(b"#")[0].removeprefix(b"OFF").split() for line in head.split(b"\n"))
    words = next((words for words in lines if words), [])
    return [int(word) for word in words[:2] if word.isdigit() and len(word) < _DIGITS]


def _no_counts(_: bytes) -> list[int]:
    return []


class Beside:
    """The files that a mesh may name: those in its own folder and below; trimesh asks it for their bytes.

    Args:
        path: the mesh.
    """

    def __init__(self, path: Path) -> None:
        self._folder, self._name = path.parent, path.name

    def get(self, name: str) -> bytes:
        """The content of a file beside the mesh.

        Raises:
            SceneError: the name leads out of the folder, or there is no such file.
        """
        named = PurePosixPath(str(name).replace("\\", "/"))
        if not named.parts or "\0" in str(named) or named.is_absolute() or ".." in named.parts or ":" in str(named):
            raise SceneError(f"{self._name} names a file outside its folder, which is not read")
        path = self._folder.joinpath(*named.parts)
        if not path.resolve().is_relative_to(self._folder.resolve()):
            raise SceneError(f"{self._name} names a file outside its folder, which is not read")
        try:
            return read_bytes(path, lambda reason, _: SceneError(f"{path.name} {reason}"))
        except FileNotFoundError as error:
            raise SceneError(f"{self._name} names a file that is not beside it") from error

    def keys(self) -> list[str]:
        """Names that can be asked for; none are offered."""
        return []
