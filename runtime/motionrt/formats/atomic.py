"""Writing a file so that it is either whole or not there."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from motionrt.errors import InvalidInputError
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown


def write_atomically(path: str | Path, write: Callable[[BinaryIO], None]) -> Path:
    """Let ``write`` fill a temporary file beside ``path``, then move it there; until then an old file stays.

    Raises:
        InvalidInputError: the system refuses (no such folder, no permission, disk full); says why.
    """
    path = as_path(path)
    if not path.name:
        raise InvalidInputError(f"cannot write {shown(str(path))}: it names no file")
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex[:8]}.tmp")
    try:
        with temporary.open("xb") as file:
            write(file)
        temporary.replace(path)
    except FileNotFoundError as error:
        raise InvalidInputError(f"cannot write {path}: there is no folder {path.parent}; make it first") from error
    except OSError as error:
        raise InvalidInputError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)
    return path


def write_bytes(path: str | Path, content: bytes) -> Path:
    """The file that holds exactly ``content``; errors as :func:`write_atomically`."""
    return write_atomically(path, lambda file: _put(file, content))


def _put(file: BinaryIO, content: bytes) -> None:
    file.write(content)
