"""Streams, tables and progress: everything that the commands print goes through here."""

from __future__ import annotations

import io
import json
import os
import shutil
import sys
import threading
import time
import unicodedata
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Literal, TextIO

Style = Literal["bold", "dim", "red", "yellow"]
_CODES: dict[Style, str] = {"bold": "1", "dim": "2", "red": "31", "yellow": "33"}
_SHOWN_AFTER_S, _DRAWN_EVERY_S = 1.0, 0.2


class _State:
    """What the run of a command has set: whether notes are wanted, and whether a line waits to be wiped."""

    quiet = False
    drawn = False


def prepare_streams() -> None:
    """A character that the console's encoding lacks is printed as an escape instead of ending the program."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def be_quiet(quiet: bool) -> None:
    """Whether notes, warnings and progress are left away; errors never are."""
    _State.quiet = quiet


def close_quietly() -> None:
    """Point stdout at nothing, so that Python's last flush does not complain about a closed pipe."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(message: str) -> None:
    """A note for people, on stderr, unless they want it quiet."""
    if not _State.quiet:
        complain(message)


def complain(message: str) -> None:
    """A line on stderr, quiet or not; control characters of files and their names do nothing to the terminal."""
    _wipe()
    plain = "".join(c if c.isprintable() or c in "\t\n" else ascii(c)[1:-1] for c in message)
    for begin, style in (("motionrt: error:", "red"), ("motionrt: warning:", "yellow")):
        if plain.startswith(begin):
            plain = styled(begin, style, sys.stderr) + plain[len(begin) :]  # type: ignore[arg-type]
    print(plain, file=sys.stderr)


def styled(text: str, style: Style, stream: TextIO) -> str:
    """``text`` in a style where ``stream`` is a terminal that knows styles; NO_COLOR turns them off."""
    return f"\x1b[{_CODES[style]}m{text}\x1b[0m" if text and _has_styles(stream) else text


def _has_styles(stream: TextIO) -> bool:
    if not stream.isatty() or os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    return os.name != "nt" or bool(os.environ.get("WT_SESSION") or os.environ.get("ANSICON"))


def print_json(value: Any) -> None:
    """Results for programs, on stdout; plain ASCII unless stdout is UTF-8."""
    encoding = (sys.stdout.encoding or "ascii").lower().replace("-", "")
    print(json.dumps(value, indent=2, ensure_ascii=encoding != "utf8"))


def print_table(header: Sequence[str], rows: Sequence[Sequence[str]], align: str) -> None:
    """Results for people, on stdout: columns by width; ``align`` has ``<`` or ``>`` for each column.

    On a terminal the header is bold, and lines end where the terminal does; in a pipe they are plain and whole.
    """
    widths = [max(map(_width, column)) for column in zip(header, *rows, strict=True)]
    room = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    for row in (header, *rows):
        cells = [_padded(cell, side, width) for cell, side, width in zip(row, align, widths, strict=True)]
        line = _cut("  ".join(cells).rstrip(), room)
        print(styled(line, "bold", sys.stdout) if row is header else line)


def _width(text: str) -> int:
    """Columns of a terminal that ``text`` takes."""
    return sum(0 if unicodedata.combining(c) else 1 + (unicodedata.east_asian_width(c) in "WF") for c in text)


def _padded(text: str, side: str, width: int) -> str:
    space = " " * (width - _width(text))
    return space + text if side == ">" else text + space


def _cut(line: str, room: int | None) -> str:
    if room is None or _width(line) <= room:
        return line
    while line and _width(line) > room - 3:
        line = line[:-1]
    return line + "..."


class Progress:
    """One line on stderr that is drawn over; silent unless stderr is a terminal."""

    def __call__(self, done: int, total: int, name: str) -> None:
        """Draw the state; the last call clears the line."""
        if done >= total:
            _wipe()
            return
        filled = 24 * done // total
        _draw(f"[{'#' * filled}{'.' * (24 - filled)}] {done}/{total} {name}")


@contextmanager
def working(what: str) -> Iterator[None]:
    """A line on stderr that counts the seconds of what takes more than one; silent unless stderr is a terminal."""
    if _State.quiet or not sys.stderr.isatty():
        yield
        return
    done = threading.Event()
    counter = threading.Thread(target=_count, args=(what, done), name="motionrt-working", daemon=True)
    counter.start()
    try:
        yield
    finally:
        done.set()
        counter.join()
        _wipe()


def _count(what: str, done: threading.Event) -> None:
    started, pause = time.monotonic(), _SHOWN_AFTER_S
    while not done.wait(pause):
        pause = _DRAWN_EVERY_S
        _draw(f"{what} ... {time.monotonic() - started:.0f} s")


def _draw(line: str) -> None:
    if _State.quiet or not sys.stderr.isatty():
        return
    columns = shutil.get_terminal_size().columns
    sys.stderr.write("\r" + _cut(line, columns - 1).ljust(columns - 1))
    sys.stderr.flush()
    _State.drawn = True


def _wipe() -> None:
    if _State.drawn:
        sys.stderr.write("\r" + " " * (shutil.get_terminal_size().columns - 1) + "\r")
        sys.stderr.flush()
        _State.drawn = False
