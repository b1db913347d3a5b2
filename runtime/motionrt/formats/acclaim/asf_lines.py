"""The lines of an ASF file: sections, blocks, and the values that stand on one line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.formats.text import shorten, to_float

Vector = npt.NDArray[np.float64]

_CHANNELS = {"tx", "ty", "tz", "rx", "ry", "rz"}


@dataclass(frozen=True)
class AsfLine:
    """The words of one line without its comment, and its 1-based number."""

    number: int
    words: list[str]

    @property
    def key(self) -> str:
        """The first word in lower case."""
        return self.words[0].lower()

    def word_at(self, i: int, path: Path) -> str:
        """Word ``i``, or a FormatError where the line is too short."""
        if i >= len(self.words):
            raise FormatError(path, f"'{shorten(' '.join(self.words))}' lacks a value", self.number)
        return self.words[i]

    def number_at(self, i: int, path: Path) -> float:
        """Word ``i`` as a finite number."""
        return to_float(self.word_at(i, path), path, self.number)

    def vector(self, path: Path) -> Vector:
        """The three numbers behind the key."""
        return np.array([self.number_at(i, path) for i in (1, 2, 3)])

    def channels(self, path: Path) -> tuple[str, ...]:
        """The channels behind ``dof`` or ``order``, in lower case."""
        names = tuple(word.lower() for word in self.words[1:])
        if len(set(names)) != len(names) or not set(names) <= _CHANNELS:
            listed = shorten(" ".join(self.words[1:]))
            raise FormatError(path, f"'{listed}' is no list of channels such as 'rx ry rz'", self.number)
        return names

    def axis_order(self, i: int, path: Path) -> str:
        """Word ``i`` as an order of axes such as ``XYZ``."""
        word = self.word_at(i, path).upper()
        if sorted(word) != ["X", "Y", "Z"]:
            raise FormatError(path, f"'{shorten(word)}' is no order of axes such as XYZ", self.number)
        return word


def sections(text: str, path: Path) -> dict[str, list[AsfLine]]:
    """The lines under each ``:section``, without comments and empty lines."""
    out: dict[str, list[AsfLine]] = {}
    current: list[AsfLine] = []
    for number, raw in enumerate(text.split("\n"), start=1):
        words = raw.split("#")[0].split()
        if words and words[0].startswith(":"):
            current = out.setdefault(words[0][1:].lower(), [])
            words = words[1:]
        if words:
            current.append(AsfLine(number, words))
    if not out:
        raise FormatError(path, "not an ASF file: it has no ':' sections", 1)
    return out


def blocks(lines: list[AsfLine], path: Path) -> Iterator[list[AsfLine]]:
    """The lines from each ``begin`` up to its ``end``, ``begin`` included."""
    block: list[AsfLine] | None = None
    for line in lines:
        if line.key == "begin":
            if block is not None:
                raise FormatError(path, "'begin' inside of a block: an 'end' is missing", line.number)
            block = [line]
        elif block is None:
            raise FormatError(path, f"expected 'begin', found '{shorten(line.words[0])}'", line.number)
        elif line.key == "end":
            yield block
            block = None
        else:
            block.append(line)
    if block is not None:
        raise FormatError(path, "the last block has no 'end'", block[0].number)
