"""A small plot for the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

BLOCKS, PLAIN = " ▁▂▃▄▅▆▇█", " .:-=+*#@"
WIDTH, HEIGHT = 72, 4


def curve_lines(
    values: Sequence[float],
    fps: float,
    marked: Sequence[tuple[float, float]] = (),
    encoding: str | None = "utf-8",
) -> list[str]:
    """Lines of text: the curve as bars, the marked spans (seconds) under it, and an axis in seconds.

    Args:
        values: one value per frame, at least one.
        fps: frames per second.
        marked: spans to underline.
        encoding: of the terminal; without block characters plain ones are drawn.
    """
    ramp = BLOCKS if _can_print(BLOCKS, encoding) else PLAIN
    columns = min(WIDTH, len(values))
    bounds = [i * len(values) // columns for i in range(columns + 1)]
    means = [sum(values[a:b]) / (b - a) for a, b in pairwise(bounds)]
    low, high = min(means), max(means)
    levels = [round((mean - low) / ((high - low) or 1) * (HEIGHT * 8 - 1)) + 1 for mean in means]
    lines = [_row(levels, row, ramp) for row in range(HEIGHT - 1, -1, -1)]
    lines[0] += f"  {high:.3f}"
    lines[-1] += f"  {low:.3f}"
    middles = [(a + b) / 2 / fps for a, b in pairwise(bounds)]
    under = "".join("^" if any(s <= t < e for s, e in marked) else "-" for t in middles)
    return [*lines, f"|{under}|", _axis(columns, len(values) / fps)]


def _row(levels: Sequence[int], row: int, ramp: str) -> str:
    return "|" + "".join(ramp[min(max(level - 8 * row, 0), 8)] for level in levels) + "|"


def _axis(columns: int, seconds: float) -> str:
    end = f"{seconds:.1f} s"
    return "0" + end.rjust(max(columns + 1, len(end) + 1))


def _can_print(text: str, encoding: str | None) -> bool:
    try:
        text.encode(encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True
