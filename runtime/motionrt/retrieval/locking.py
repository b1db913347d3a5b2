"""One writer at a time: a lock that the operating system drops when its holder dies."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from motionrt.errors import GalleryError

LOCK_NAME = ".lock"
_BUSY = {errno.EACCES, errno.EAGAIN, errno.EDEADLK}


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Hold the folder's lock, creating the folder.

    On a file system without locks the block runs unlocked: then the last writer wins, and a reader still
    sees one whole gallery.

    Raises:
        GalleryError: another process is writing there, or the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder / LOCK_NAME, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        raise GalleryError(f"cannot write to {folder} ({error.strerror}); choose another folder") from error
    try:
        _lock(handle, folder)
        yield
    finally:
        os.close(handle)


def _lock(handle: int, folder: Path) -> None:
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _BUSY:
            raise GalleryError(f"another process is writing to {folder}; try again when it has finished") from error
