"""A gallery's folder: ``gallery.json`` and the files that it names.

The files' names carry their checksum, and ``gallery.json`` is replaced last, in one step. So whoever
opens the folder, at any moment and after any crash, sees one whole gallery: the old one or the new one.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, GalleryError, GalleryNotFoundError
from motionrt.retrieval.head import check_seal, parsed, sealed
from motionrt.untrusted import Fail
from motionrt.untrusted.files import plain_file, read_bytes
from motionrt.untrusted.npz import read_npy
from motionrt.untrusted.words import shown

GALLERY_FILE = "gallery.json"
DEFAULT_FOLDER = ".motionrt-gallery"
FORMAT, VERSION, OLDEST = "motionrt-gallery", 2, 1
_PART = re.compile(
    r"(clips|embeddings|windows|motions|attributes|captions|words|deleted)-[0-9a-f]{16}\.(np[yz]|safetensors)"
)
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
    if head.get("version") not in range(OLDEST, VERSION + 1) or isinstance(head.get("version"), bool | float):
        raise GalleryError(
            f"{path} has version {shown(head.get('version'))}, this motionrt reads up to {VERSION}; build it again"
        )
    check_seal(content, head, fails(path))
    return head


def read_array(folder: Path, name: str) -> npt.NDArray[Any]:
    """One array, memory-mapped; FileNotFoundError when it is not there, GalleryError when it is damaged."""
    return np.asarray(read_npy(folder / name, fails(folder / name)))


@contextmanager
def writing_to(folder: Path) -> Iterator[Writing]:
    """Write to a gallery's folder, whose lock the caller holds; whatever fails, the gallery that was there stays::

        with writing_to(folder) as disk:
            name = disk.part("clips", ".safetensors", writer)
            disk.commit({"segments": [...]}, {name})

    Raises:
        GalleryError: the disk refuses.
    """
    before = {path.name for path in folder.iterdir()}
    try:
        yield Writing(folder)
    except BaseException as error:
        _remove_new(folder, before)
        if isinstance(error, OSError):
            raise GalleryError(f"cannot write the gallery to {folder}: {error.strerror}") from error
        raise


class Writing:
    """A gallery's folder while it is written: files first, then ``gallery.json`` with their names."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def part(self, role: str, suffix: str, writer: Writer) -> str:
        """Write a file of that role; gives its name."""
        temporary = _write_temporary(self._folder, role, writer)
        checksum = digest(temporary)
        path = self._folder / f"{role}-{checksum[:16]}{suffix}"
        if path.is_file() and digest(path) == checksum:  # a reader may have it mapped: then it cannot be replaced
            temporary.unlink()
        else:
            temporary.replace(path)
        return path.name

    def commit(self, head: dict[str, Any], kept: set[str]) -> None:
        """Replace ``gallery.json`` and drop all parts but those that it names, which are ``kept``."""
        head = {"format": FORMAT, "version": VERSION, "created_by": _created_by(), **head}
        _replace(self._folder, GALLERY_FILE, lambda file: _discard(file.write(sealed(head))))
        _remove_stale(self._folder, kept | {neighbours_name(name) for name in kept})


def neighbours_name(embeddings: str) -> str:
    """Name of the file that may keep the graph of neighbours of the embeddings in the file of that name.

    It carries their checksum, so it is never taken for that of others; it is made when first asked for.
    """
    return f"neighbours-{embeddings.partition('-')[2].partition('.')[0]}.faiss"


def digest(path: Path) -> str:
    """The sha256 of a plain file; FormatError for a pipe, a device or a folder."""
    checksum = hashlib.sha256()
    plain_file(path, lambda reason, _: FormatError(path, reason))
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
        ours = _PART.fullmatch(path.name) or _NEIGHBOURS.fullmatch(path.name)
        stale = ours and path.name not in keep
        if stale or path.name.startswith(TEMPORARY):
            try:
                path.unlink()
            except OSError:  # mapped by a reader, on Windows: the next writer removes it
                continue


def _remove_new(folder: Path, before: set[str]) -> None:
    """What a write that failed, or was broken off, left behind: it names nothing and fills the disk."""
    for path in folder.iterdir():
        left = path.name.startswith(TEMPORARY) or (_PART.fullmatch(path.name) and path.name not in before)
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
