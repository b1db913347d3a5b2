"""What all windows of a studio share: the models, a gallery, and a folder to save in."""

from __future__ import annotations

import contextlib
import re
import tempfile
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.formats import WRITABLE_SUFFIXES, Character
from motionrt.motion import Motion
from motionrt.untrusted.names import plain_stem

if TYPE_CHECKING:
    from motionrt.runtime import Runtime


CHARACTER_FORMATS = ("glb", "bvh")


@dataclass(frozen=True, eq=False)
class Workshop:
    """Tools of a studio.

    Attributes:
        runtime: whose verbs are called.
        gallery: what is searched; None for the starter gallery.
        folder: where files may be saved on this machine; None for nowhere: they are downloaded.
        local: whether only this machine sees the page. A page names no files of the machine in either case.
        desk: held by whoever uses the models.
    """

    runtime: Runtime
    gallery: Path | None = None
    folder: Path | None = None
    local: bool = True
    desk: threading.Lock = field(default_factory=threading.Lock)

    def open_ahead(self) -> None:
        """Begin to open the models that a first search and a first generation need, beside everything else."""
        threading.Thread(target=self._open, daemon=True, name="motionrt models").start()

    def _open(self) -> None:
        with contextlib.suppress(MotionRTError), self.desk:  # whoever needs them is told what is wrong
            self.runtime.gallery(self.gallery)
            self.runtime.retrieve("walk", 1, self.gallery)
        with contextlib.suppress(MotionRTError), self.desk:
            self.runtime.generate("walk", 1.0, seed=0)


def formats() -> tuple[str, ...]:
    """Names of the formats that motions can be saved in, as in ``bvh``."""
    return tuple(suffix.lstrip(".") for suffix in WRITABLE_SUFFIXES)


def motion_bytes(motion: Motion, form: str) -> bytes:
    """A motion as the content of a file.

    Raises:
        InvalidInputError: an unknown format.
    """
    if form not in formats():
        raise InvalidInputError(f"unknown format '{form}'; there are: {', '.join(formats())}")
    with tempfile.TemporaryDirectory() as folder:
        return motion.save(Path(folder) / f"motion.{form}").read_bytes()


def character_bytes(character: Character, motion: Motion, form: str) -> bytes:
    """A motion on a character of the user's own as the content of a file.

    Raises:
        InvalidInputError: another format than a character can be written in.
        RigError: the motion cannot be played on it.
    """
    if form not in CHARACTER_FORMATS:
        raise InvalidInputError(f"a character is written as {' or '.join(CHARACTER_FORMATS)}")
    with tempfile.TemporaryDirectory() as folder:
        return character.retargeted(motion).save(Path(folder) / f"motion.{form}").read_bytes()


def file_name(name: str, suffix: str) -> str:
    """A name that every file system takes."""
    plain = re.sub(r"\.(bvh|amc|npz|glb|ya?ml)$", "", name.strip(), flags=re.IGNORECASE)
    return f"{plain_stem(plain.replace('/', '__')) or 'motion'}.{suffix}"


def save_in(folder: Path, name: str, content: bytes) -> Path:
    """Write a file into a folder, beside those that are there; returns where.

    Raises:
        InvalidInputError: it cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / name
        number = 1
        while path.exists():
            number += 1
            path = folder / f"{Path(name).stem}-{number}{Path(name).suffix}"
        path.write_bytes(content)
    except OSError as error:
        raise InvalidInputError(f"cannot save in {folder}: {error.strerror or error}") from error
    return path
