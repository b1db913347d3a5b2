"""A gallery's folder: ``gallery.json`` and the arrays that it names.

The arrays' file names carry their checksum, and ``gallery.json`` is replaced last, in one step. So whoever
opens the folder, at any moment and after any crash, sees one whole gallery: the old one or the new one.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, GalleryError, GalleryNotFoundError
from motionrt.retrieval.head import check_seal, parsed, sealed
from motionrt.untrusted import Fail
from motionrt.untrusted.files import check_file, read_bytes
from motionrt.untrusted.npz import read_npy
from motionrt.untrusted.words import shown

GALLERY_FILE = "gallery.json"
DEFAULT_FOLDER = ".motionrt-gallery"
FORMAT, VERSION = "motionrt-gallery", 1
_ARRAY_FILE = re.compile(r"(embeddings|windows|motions|attributes|words)-[0-9a-f]{16}\.np[yz]")
_NEIGHBOURS = re.compile(r"neighbours-[0-9a-f]{16}\.faiss")
TEMPORARY = ".writing-"

Writer = Callable[[IO[bytes]], None]


def locate(path: Path) -> Path:
    """The gallery folder meant by ``path``: itself, or the one inside an indexed folder.

    Raises:
        GalleryNotFoundError: there is none; the message gives the command that builds it.
    """
    for folder in (path, path / DEFAULT_FOLDER):
        if (folder / GALLERY_FILE).is_file():
            return folder
    raise GalleryNotFoundError(f'no gallery in {path}; build one with: motionrt gallery build "{path}"')


def read_head(folder: Path) -> dict[str, Any]:
    """The content of ``gallery.json``; GalleryError when it is damaged or of another version."""
    path = folder / GALLERY_FILE
    try:
        content = read_bytes(path, fails(path))
    except FileNotFoundError as error:
        raise damaged(path, "it is gone") from error
    head = parsed(content, fails(path))
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise damaged(path, "not a gallery of motionrt")
    if head.get("version") != VERSION:
        raise GalleryError(
            f"{path} has version {shown(head.get('version'))}, this motionrt reads version {VERSION}; build it again"
        )
    check_seal(content, head, fails(path))
    return head


def read_array(folder: Path, name: str) -> npt.NDArray[Any]:
    """One array, memory-mapped; FileNotFoundError when it is not there, GalleryError when it is damaged."""
    return np.asarray(read_npy(folder / name, fails(folder / name)))


def write(folder: Path, head: dict[str, Any], arrays: dict[str, tuple[str, Writer]]) -> None:
    """Write arrays (role -> suffix and writer), then ``gallery.json`` with their names, then drop the stale.

    The caller holds the folder's lock.

    Raises:
        GalleryError: the disk refuses.
    """
    before = {path.name for path in folder.iterdir()}
    try:
        files = {role: _write_array(folder, role, *how) for role, how in arrays.items()}
        head = {"format": FORMAT, "version": VERSION, "created_by": _created_by(), **head, "files": files}
        _replace(folder, GALLERY_FILE, lambda file: _discard(file.write(sealed(head))))
    except BaseException as error:
        _remove_new(folder, before)
        if isinstance(error, OSError):
            raise GalleryError(f"cannot write the gallery to {folder}: {error.strerror}") from error
        raise
    kept = set(files.values())
    _remove_stale(folder, kept | {neighbours_name(name) for name in kept})


def neighbours_name(embeddings: str) -> str:
    """Name of the file that may keep the graph of neighbours of the embeddings in the file of that name.

    It carries their checksum, so it is never taken for that of others; it is made when first asked for.
    """
    return f"neighbours-{embeddings.partition('-')[2].partition('.')[0]}.faiss"


def digest(path: Path) -> str:
    """The sha256 of a plain file; FormatError for a pipe, a device or a file that is too large."""
    checksum = hashlib.sha256()
    check_file(path, lambda reason, _: FormatError(path, reason))
    with path.open("rb") as file:
        while block := file.read(1 << 20):
            checksum.update(block)
    return checksum.hexdigest()


def verify(folder: Path, files: dict[str, str]) -> None:
    """Check every array against the checksum in its name; GalleryError names the first that differs."""
    for name in files.values():
        try:
            found = digest(folder / name)
        except (OSError, FormatError) as error:
            raise damaged(folder / name, str(error)) from error
        if f"-{found[:16]}." not in name:
            raise damaged(folder / name, "its checksum is wrong")


def fails(path: Path) -> Fail:
    """Makes the error for a gallery file that cannot be used out of a reason."""
    return lambda reason, _: damaged(path, reason)


def damaged(path: Path, reason: str) -> GalleryError:
    """The error for a gallery file that cannot be used."""
    return GalleryError(f"{path} is damaged ({reason}); build the gallery again: motionrt gallery build")


def _write_array(folder: Path, role: str, suffix: str, writer: Writer) -> str:
    temporary = _write_temporary(folder, role, writer)
    checksum = digest(temporary)
    path = folder / f"{role}-{checksum[:16]}{suffix}"
    if path.is_file() and digest(path) == checksum:  # a reader may have it mapped: then it cannot be replaced
        temporary.unlink()
    else:
        temporary.replace(path)
    return path.name


def _replace(folder: Path, name: str, writer: Writer) -> None:
    _write_temporary(folder, name, writer).replace(folder / name)


def _write_temporary(folder: Path, name: str, writer: Writer) -> Path:
    path = folder / f"{TEMPORARY}{name}"
    with path.open("wb") as file:
        writer(file)
        file.flush()
        os.fsync(file.fileno())
    return path


def _remove_stale(folder: Path, keep: set[str]) -> None:
    for path in folder.iterdir():
        ours = _ARRAY_FILE.fullmatch(path.name) or _NEIGHBOURS.fullmatch(path.name)
        stale = ours and path.name not in keep
        if stale or path.name.startswith(TEMPORARY):
            try:
                path.unlink()
            except OSError:  # mapped by a reader, on Windows: the next writer removes it
                continue


def _remove_new(folder: Path, before: set[str]) -> None:
    """What a write that failed, or was broken off, left behind: it names nothing and fills the disk."""
    for path in folder.iterdir():
        left = path.name.startswith(TEMPORARY) or (_ARRAY_FILE.fullmatch(path.name) and path.name not in before)
        if left:
            with suppress(OSError):
                path.unlink()


def _created_by() -> str:
    from importlib import metadata  # slow to import, and only writers need it

    try:
        return f"motionrt {metadata.version('motionrt')}"
    except metadata.PackageNotFoundError:
        return "motionrt"


def _discard(_: object) -> None:
    return None
