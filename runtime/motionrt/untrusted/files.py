"""Bytes of a file that somebody named: a plain file, of a size that can be read."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import Fail
from motionrt.untrusted.words import shown

_KINDS = (
    (stat.S_ISDIR, "is a folder"),
    (stat.S_ISFIFO, "is a pipe"),
    (stat.S_ISSOCK, "is a socket"),
    (stat.S_ISCHR, "is a device"),
    (stat.S_ISBLK, "is a device"),
)


def as_path(path: object) -> Path:
    """A path that a caller gave.

    Raises:
        InvalidInputError: it is no ``str`` or ``os.PathLike`` of text, or no system could have such a file.
    """
    if isinstance(path, bytes) or not isinstance(path, str | os.PathLike):
        raise InvalidInputError(f"a file is given by a str or a pathlib.Path, not {shown(path)}")
    found = Path(path)
    if "\0" in str(found):
        raise InvalidInputError(f"no file is called {shown(str(found))}: it has a NUL in it")
    try:
        os.fsencode(found)
    except UnicodeEncodeError as error:
        raise InvalidInputError(f"no file is called {shown(str(found))}: it has half a character in it") from error
    return found


_confined: ContextVar[Path | None] = ContextVar("motionrt_confined", default=None)


@contextmanager
def confined(folder: Path) -> Iterator[None]:
    """While this holds, files may only name files of one folder, by their plain names: see :func:`beside`."""
    token = _confined.set(folder)
    try:
        yield
    finally:
        _confined.reset(token)


def is_confined() -> bool:
    """Whether files may only name files of one folder now."""
    return _confined.get() is not None


def beside(folder: Path, name: str, fail: Fail) -> Path:
    """The path of a file that another file names, relative to its folder.

    Whether it exists is not said where only uploaded files may be named: everything else is refused alike.
    """
    if "\0" in name:
        raise fail("names a file with a NUL in its name", None)
    only = _confined.get()
    if only is None:
        return folder / name
    if Path(name).name != name or "\\" in name or ":" in name or not (only / name).is_file():
        raise fail(f"names the file {shown(name)}, which was not uploaded; upload it first, by that name alone", None)
    return only / name


def check_file(path: Path, fail: Fail, limit: str = "file_bytes") -> int:
    """The size of a plain file in bytes; pipes, devices, folders, loops of links and too large files are refused.

    Raises:
        FileNotFoundError: there is no such file; the caller says it in its own words.
    """
    size = plain_file(path, fail)
    if size > getattr(limits(), limit):
        raise fail(f"has {size:,} bytes: {how_to_raise(limit)}", None)
    return size


def plain_file(path: Path, fail: Fail) -> int:
    """As :func:`check_file`, of any size: for files that are mapped, or read piece by piece."""
    try:
        found = path.stat()
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as error:  # a loop of links, a name too long, a NUL in it
        raise fail(f"cannot be read: {getattr(error, 'strerror', None) or error}", None) from error
    if not stat.S_ISREG(found.st_mode):
        what = next((words for test, words in _KINDS if test(found.st_mode)), "is no file")
        raise fail(f"{what}, not a file", None)
    return found.st_size


def read_bytes(path: Path, fail: Fail, limit: str = "file_bytes") -> bytes:
    """The content of a plain file; FileNotFoundError as for :func:`check_file`."""
    check_file(path, fail, limit)
    most = int(getattr(limits(), limit))
    try:
        with path.open("rb") as file:
            content = file.read(most + 1)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise fail(f"cannot be read: {error.strerror or error}", None) from error
    if len(content) > most:  # it grew meanwhile, or says another size than it has
        raise fail(f"has more than {most:,} bytes: {how_to_raise(limit)}", None)
    return content


def read_utf8(path: Path, fail: Fail, limit: str = "file_bytes") -> str:
    """The content of a plain file of UTF-8 text, with or without a byte order mark."""
    content = read_bytes(path, fail, limit)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise fail(f"is not UTF-8 text ({error.reason}); save it as UTF-8", line) from error
