"""The name of a file that is to be written, looked at before anything is made for it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown


def checked_output(path: str | Path, suffixes: Sequence[str], verb: str = "written") -> Path:
    """A file that can be written: of a known kind, not a folder, in a folder that is there.

    Args:
        path: the file.
        suffixes: what its kind may be, in lower case; empty where any will do.
        verb: what is done with the file, for messages.

    Raises:
        InvalidInputError: it is none; the message says how to name one.
    """
    path = as_path(path)
    kind = suffixes[0] if suffixes else ""
    if path.is_dir() or not path.name:
        inside = path / f"motion{kind}"
        raise InvalidInputError(f"{path} is a folder; give a file in it, as in {inside}")
    checked_suffix(path, suffixes, verb)
    if not path.parent.is_dir():
        if path.parent.exists():
            raise InvalidInputError(f"cannot write {path}: {path.parent} is a file, not a folder")
        raise InvalidInputError(f"cannot write {path}: there is no folder {path.parent}; make it first")
    return path


def checked_suffix(path: Path, suffixes: Sequence[str], verb: str) -> str:
    """The suffix of a file in lower case, which is one of ``suffixes``; InvalidInputError lists them."""
    suffix = path.suffix.lower()
    if suffix in suffixes or not suffixes:
        return suffix
    known = ", ".join(suffixes)
    if not suffix:
        name = path.name.rstrip(".") or "motion"
        hint = f"name it {name}{suffixes[0]}, for instance; can be: {known}"
        raise InvalidInputError(f"{shown(str(path))} has no suffix, which would say its kind: {hint}")
    raise InvalidInputError(f"{path}: a file '{suffix}' cannot be {verb}; can be: {known}")
