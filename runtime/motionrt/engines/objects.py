"""The files of a library in a folder or an object store, through fsspec."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import Any

from motionrt.engines.packages import package
from motionrt.errors import InvalidInputError, MissingDependencyError, MotionFileNotFoundError
from motionrt.formats import MOTION_SUFFIXES
from motionrt.formats.folder import Stamp
from motionrt.retrieval import GALLERY_FILE
from motionrt.untrusted.words import shown

_BESIDE = {".amc": ".asf", ".gltf": ".bin"}
"""Files of these suffixes need those that lie beside them."""
_TIMES = ("mtime", "LastModified", "last_modified", "updated", "created")


def find_objects(url: str) -> dict[str, Stamp]:
    """Size and time of every motion file below a folder, by relative path; what is hidden, and galleries, are left out.

    Where the store tells no time, the file's ETag stands for it.

    Args:
        url: a folder, or the address of one, as fsspec takes it: ``s3://bucket/library``.

    Raises:
        MotionFileNotFoundError: no such folder.
        InvalidInputError: no such kind of address, or not one motion file there.
        MissingDependencyError: fsspec, or its part for this kind of address, is not installed.
    """
    files, root = _opened(url)
    if not files.isdir(root):
        raise MotionFileNotFoundError(f"no folder {url}")
    listed = {PurePosixPath(path).relative_to(root): told for path, told in files.find(root, detail=True).items()}
    galleries = {path.parent for path in listed if path.name == GALLERY_FILE} - {PurePosixPath()}
    motions = [path for path in sorted(listed) if path.suffix.lower() in MOTION_SUFFIXES and not _hidden(path)]
    found = {
        path.as_posix(): (int(listed[path].get("size") or 0), _time_ns(listed[path]))
        for path in motions
        if galleries.isdisjoint(path.parents)
    }
    if not found:
        raise InvalidInputError(f"no motion files ({', '.join(MOTION_SUFFIXES)}) in {url} or below it")
    return found


@contextmanager
def fetched(url: str, names: Iterable[str], asf: str | None = None) -> Iterator[Path]:
    """A folder of this machine that holds those files, and what they need beside them, while it is needed.

    Args:
        url: the folder, as :func:`find_objects` takes it.
        names: paths below it.
        asf: the skeleton of all ``.amc``, a path below it.

    Raises:
        OSError: the store cannot be read.
    """
    files, root = _opened(url)
    if "file" in _protocols(files):
        yield Path(root)
        return
    with tempfile.TemporaryDirectory(prefix="motionrt-") as place:
        for name in {*names, *_needed(files, root, names), *([asf] if asf else [])}:
            target = Path(place, name)
            target.parent.mkdir(parents=True, exist_ok=True)
            files.get_file(f"{root}/{name}", str(target))
        yield Path(place)


def _hidden(path: PurePosixPath) -> bool:
    return any(part.startswith(".") for part in path.parts)


def _needed(files: Any, root: str, names: Iterable[str]) -> set[str]:
    """What lies beside the files and is read with them."""
    folders = {(str(PurePosixPath(name).parent), _BESIDE.get(PurePosixPath(name).suffix.lower())) for name in names}
    found = set()
    for folder, suffix in folders:
        if suffix is not None:
            listed = files.ls(f"{root}/{folder}" if folder != "." else root, detail=False)
            same = [path for path in listed if path.lower().endswith(suffix)]
            found |= {PurePosixPath(path).relative_to(root).as_posix() for path in same}
    return found


def _opened(url: str) -> tuple[Any, str]:
    """The file system of an address, and the folder's path in it."""
    core = package("fsspec.core", "a library that is no folder of this machine", "cluster")
    try:
        files, root = core.url_to_fs(url)
    except ImportError as error:
        raise MissingDependencyError(f"{url} needs one package more: {error}") from error
    except ValueError as error:
        raise InvalidInputError(f"{shown(url)} is no folder that fsspec knows: {error}") from error
    return files, str(root).rstrip("/")


def _protocols(files: Any) -> tuple[str, ...]:
    return (files.protocol,) if isinstance(files.protocol, str) else tuple(files.protocol)


def _time_ns(told: Mapping[str, Any]) -> int:
    time = next((told[name] for name in _TIMES if told.get(name) is not None), None)
    if isinstance(time, datetime):
        return int(time.timestamp() * 1e6) * 1000
    if isinstance(time, int | float):
        return int(time * 1e6) * 1000
    tag = str(time or told.get("ETag") or told.get("etag") or "")
    return int.from_bytes(hashlib.sha256(tag.encode()).digest()[:7], "big") if tag else 0
