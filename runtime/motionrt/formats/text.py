"""What every text format needs: decoding, numbers in bulk, and the line on which something is wrong."""

from __future__ import annotations

import codecs
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt.untrusted import files
from motionrt.untrusted.files import check_file

_LFS_POINTER = b"version https://git-lfs"

LARGEST_VALUE = 1e7
"""No coordinate (file units) and no angle (degrees) of a sane file is larger; float32 would be noise."""


_PLAIN = "0123456789+-.eE \t\n"
_BLOCK = 1 << 19  # characters
_START = 256  # bytes by which UTF-16 is known


def require_file(path: Path) -> None:
    """Raise MotionFileNotFoundError or FormatError unless ``path`` is an ordinary file."""
    try:
        check_file(path, lambda reason, line: FormatError(path, reason, line))
    except FileNotFoundError as error:
        raise MotionFileNotFoundError(f"no such motion file: {path}") from error


def read_bytes(path: Path) -> bytes:
    """All bytes of a file; what the system refuses to read becomes a FormatError."""
    try:
        return files.read_bytes(path, lambda reason, line: FormatError(path, reason, line))
    except FileNotFoundError as error:
        raise MotionFileNotFoundError(f"no such motion file: {path}") from error


def read_text(path: Path) -> str:
    """The text of a file with Unix line ends: UTF-8 or UTF-16, with marks or without, else Latin-1; no binary files."""
    raw = read_bytes(path)
    if raw.startswith(_LFS_POINTER):
        raise FormatError(path, "is a pointer of git LFS, not the file itself: fetch it with 'git lfs pull'")
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return _unix_lines(raw.decode("utf-16", errors="replace"))
    if wide := _wide(raw):
        return _unix_lines(raw.decode(wide, errors="replace"))
    raw = raw.rstrip(b"\0\x1a \t\r\n")  # padding, and the end of a text in old systems
    if not raw:
        raise FormatError(path, "the file is empty")
    if b"\0" in raw:
        raise FormatError(path, "this is a binary file, not text")
    try:
        return _unix_lines(raw.decode("utf-8-sig"))
    except UnicodeDecodeError:
        return _unix_lines(raw.decode("latin-1"))


def _wide(raw: bytes) -> str | None:
    """The UTF-16 of a text without a mark: plain letters with a zero byte before or after each of them."""
    start = raw[:_START]
    zeros, letters = start[1::2], start[0::2]
    for even, odd, name in ((letters, zeros, "utf-16-le"), (zeros, letters, "utf-16-be")):
        if len(start) >= 8 and not any(odd) and even.isascii() and b"\0" not in even:
            return name
    return None


def _unix_lines(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def line_of(text: str, position: int) -> int:
    """1-based line number of a character position."""
    return text.count("\n", 0, position) + 1


def to_float(word: str, path: Path, line: int) -> float:
    """One finite number of sane size, or a FormatError that quotes the word."""
    try:
        value = float(word)
    except ValueError:
        raise FormatError(path, f"expected a number, found '{shorten(word)}'", line) from None
    if not math.isfinite(value):
        raise FormatError(path, f"'{shorten(word)}' is not a finite number", line)
    if abs(value) > LARGEST_VALUE:
        raise FormatError(path, f"{shorten(word)} is too large for a coordinate or an angle", line)
    return value


def numbers_in(text: str, count: int) -> npt.NDArray[np.float64] | None:
    """All numbers of a text that holds nothing else; ``None`` where a word is no finite number of sane size.

    Quick where there are ``count`` of them.
    """
    values = _at_once(text)
    if values is not None and values.size == count:
        return values
    return _by_words(text)


def _at_once(text: str) -> npt.NDArray[np.float64] | None:
    """The numbers that NumPy reads in a text of plain numbers, which may end early; ``None`` for any other text.

    They are finite and of sane size.
    """
    parts = []
    for block in _blocks(text):
        if block.strip(_PLAIN):
            return None
        try:
            part = np.fromstring(block, dtype=np.float64, sep=" ")
        except (ValueError, DeprecationWarning):  # "1-2"; older versions of NumPy end there
            return None
        if not (np.abs(part) <= LARGEST_VALUE).all():
            return None
        parts.append(part)
    return np.concatenate(parts) if parts else np.empty(0)


def _by_words(text: str) -> npt.NDArray[np.float64] | None:
    """All numbers of a text, a block at a time: words cost much more memory than numbers."""
    parts = []
    for block in _blocks(text):
        part = to_floats(block.split())
        if part is None:
            return None
        parts.append(part)
    return np.concatenate(parts) if parts else np.empty(0)


def _blocks(text: str) -> Iterator[str]:
    """Some whole lines of a text at a time: Ctrl-C is heard between them."""
    at = 0
    while at < len(text):
        end = text.find("\n", at + _BLOCK) + 1 or len(text)
        yield text[at:end]
        at = end


def to_floats(words: list[str]) -> npt.NDArray[np.float64] | None:
    """All words as numbers at once, or ``None`` if any is no finite number of sane size."""
    try:
        values = np.fromiter(map(float, words), dtype=np.float64, count=len(words))
    except ValueError:
        return None
    return values if bool((np.abs(values) <= LARGEST_VALUE).all()) else None


def shorten(text: str, limit: int = 40) -> str:
    """A piece of a file, fit to be quoted in a message."""
    clean = "".join(c if c.isprintable() else "?" for c in text)
    return clean if len(clean) <= limit else clean[: limit - 3] + "..."
