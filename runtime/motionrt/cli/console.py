"""Streams, tables and progress: everything that the commands print goes through here."""

from __future__ import annotations

import io
import json
import os
import shutil
import sys
from collections.abc import Sequence
from typing import Any


def prepare_streams() -> None:
    """A character that the console's encoding lacks is printed as an escape instead of ending the program."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def close_quietly() -> None:
    """Point stdout at nothing, so that Python's last flush does not complain about a closed pipe."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(message: str) -> None:
    """A line for people, on stderr; control characters of files and their names do nothing to the terminal."""
    print("".join(c if c.isprintable() or c in "\t\n" else ascii(c)[1:-1] for c in message), file=sys.stderr)


def print_json(value: Any) -> None:
    """Results for programs, on stdout; plain ASCII unless stdout is UTF-8."""
    encoding = (sys.stdout.encoding or "ascii").lower().replace("-", "")
    print(json.dumps(value, indent=2, ensure_ascii=encoding != "utf8"))


def print_table(header: Sequence[str], rows: Sequence[Sequence[str]], align: str) -> None:
    """Results for people, on stdout: columns by width; ``align`` has ``<`` or ``>`` for each column."""
    widths = [max(map(len, column)) for column in zip(header, *rows, strict=True)]
    for row in (header, *rows):
        cells = [f"{cell:{side}{width}}" for cell, side, width in zip(row, align, widths, strict=True)]
        print("  ".join(cells).rstrip())


class Progress:
    """One line on stderr that is drawn over; silent unless stderr is a terminal."""

    def __init__(self) -> None:
        self._shown = sys.stderr.isatty()

    def __call__(self, done: int, total: int, name: str) -> None:
        """Draw the state; the last call clears the line."""
        if not self._shown:
            return
        columns = shutil.get_terminal_size().columns
        filled = 24 * done // total
        line = f"[{'#' * filled}{'.' * (24 - filled)}] {done}/{total} {name}"
        sys.stderr.write("\r" + (line if done < total else "")[: columns - 1].ljust(columns - 1))
        sys.stderr.write("" if done < total else "\r")
        sys.stderr.flush()
