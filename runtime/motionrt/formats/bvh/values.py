"""The numbers of a BVH file: all at once where they are sound, line by line where one is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.formats.text import line_of, numbers_in, to_float

Values = npt.NDArray[np.float64]


def read_values(text: str, at: int, shape: tuple[int, int], path: Path) -> tuple[Values, tuple[str, ...]]:
    """Channel values ``(F, C)`` from position ``at`` of the text to its end, and notes.

    ``shape`` is what the file declares. Where it holds another number of whole lines of ``C`` values, those count: many
    exporters are off by one, and an interrupted export ends within a line.
    """
    values = numbers_in(text[at:], shape[0] * shape[1])
    if values is not None and values.size == shape[0] * shape[1] and values.size:
        return values.reshape(shape), ()
    if values is not None and not values.size:
        raise FormatError(path, "the file has no frames", line_of(text, at))
    whole = None if values is None else _whole_lines(text[at:], shape[1])
    if values is None or not whole:
        raise _diagnose(text[at:], line_of(text, at), shape, path)
    cut = " and ends within another" if values.size > whole * shape[1] else ""
    note = f"declares {shape[0]} frames but holds {whole} whole ones{cut}; those {whole} are read"
    return values[: whole * shape[1]].reshape(whole, shape[1]), (note,)


def _whole_lines(text: str, channels: int) -> int:
    """Number of filled lines of ``channels`` values; 0 if any but the last has another number."""
    counts = [count for count in (len(line.split()) for line in text.split("\n")) if count]
    if counts and counts[-1] < channels:
        counts.pop()
    return len(counts) if set(counts) == {channels} else 0


def _diagnose(text: str, first_line: int, shape: tuple[int, int], path: Path) -> FormatError:
    """What is wrong with the values, and on which line."""
    rows = [(number, line.split()) for number, line in enumerate(text.split("\n"), start=first_line)]
    rows = [(number, words) for number, words in rows if words]
    try:
        for number, words in rows:
            for word in words:
                to_float(word, path, number)
    except FormatError as error:
        return error
    return _wrong_count([(number, len(words)) for number, words in rows], first_line, shape, path)


def _wrong_count(rows: list[tuple[int, int]], first_line: int, shape: tuple[int, int], path: Path) -> FormatError:
    """An error for a wrong number of values, given line number and number of values of every filled line."""
    frames, channels = shape
    total = sum(count for _, count in rows)
    declared = f"the file declares {frames} frames of {channels} values"
    if len(rows) == frames:
        line, count = next((line, count) for line, count in rows if count != channels)
        return FormatError(path, f"{count} values on this line instead of {channels}: {declared}", line)
    end = f", it ends in frame {total // channels + 1}" if total < frames * channels else ""
    last_line = rows[-1][0] if rows else first_line
    return FormatError(path, f"{declared} but holds {total / channels:.6g} frames{end}", last_line)
