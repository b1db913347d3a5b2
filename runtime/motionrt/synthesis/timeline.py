"""Timelines: several texts one after another and several at once, each with its time and its parts of the body."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models.text import FloatArray, checked_text
from motionrt.motion.body_parts import PARTS, checked_parts
from motionrt.motion.features import ego77
from motionrt.synthesis.canvas import Piece, Words
from motionrt.synthesis.sampling import SECONDS, SHORTEST_S
from motionrt.text import clauses
from motionrt.untrusted.arguments import checked_number

LONGEST_S = 9.5  # of one text; the network knows 10 s, and neighbours overlap
OVERLAP = 5  # frames at 20 fps on either side of a change over which texts pass into each other
SHORTEST_ACT_S = 1.0  # of acts of a text that follow one another; with less time they are one
NETWORK = 200  # frames that the network can see at once
_KEYS = ("text", "seconds", "from", "to", "parts")

Item = str | tuple[str, float] | Mapping[str, Any]
"""A text; a text and its seconds; or a mapping with ``text`` and ``seconds``, or ``from`` and ``to``, and ``parts``."""


@dataclass(frozen=True)
class Line:
    """A text of a timeline.

    Attributes:
        text: what somebody does.
        start, end: seconds from the beginning of the timeline.
        parts: names of :data:`motionrt.PARTS` that it moves; None is the whole body, below all that name parts.
    """

    text: str
    start: float
    end: float
    parts: frozenset[str] | None = None


def lines_of_text(text: str, seconds: float) -> tuple[Line, ...]:
    """The acts of a text that follow one another, each with its share of the seconds; one line where there is one."""
    acts = clauses(text)
    share = seconds / len(acts)
    if len(acts) < 2 or share < SHORTEST_ACT_S:
        return (Line(text, 0.0, seconds),)
    times = [*(round(10 * share * k) / 10 for k in range(len(acts))), seconds]
    return tuple(Line(act, times[k], times[k + 1]) for k, act in enumerate(acts))


def read_timeline(items: Sequence[Item], label: Callable[[str], frozenset[str]]) -> tuple[Line, ...]:
    """Checked lines in the order given; those without ``from`` follow the one before.

    Texts that lie upon others and name no parts get them of ``label``.

    Raises:
        InvalidInputError: another form, times that cannot be, or a moment that no text speaks of.
    """
    if isinstance(items, str | Mapping) or not isinstance(items, Sequence) or not items:
        raise InvalidInputError("a timeline is a list of texts, as in [('walk forward', 3), ('sit down', 2)]")
    lines: list[Line] = []
    clock = 0.0
    for number, item in enumerate(items, 1):
        line = _line(item, clock, f"line {number} of the timeline")
        if line.parts is None and any(line.start < other.end and other.start < line.end for other in lines):
            line = Line(line.text, line.start, line.end, label(line.text) or None)
        clock = line.end if line.parts is None else clock
        lines.append(line)
    _check_covered(lines)
    return tuple(lines)


def pieces(lines: Sequence[Line], words: Callable[[str, float], Words]) -> tuple[list[Piece], int]:
    """What is denoised of the lines, and the frames at 20 fps of the whole."""
    frames = max(round(line.end * ego77.FPS) for line in lines) + 1
    frames = min(frames, NETWORK) if len(lines) == 1 else frames
    spans = [_span(line, frames) for line in lines]
    owned = [_owned(line, span, frames) for line, span in zip(lines, spans, strict=True)]
    _give_way(lines, owned)
    found = []
    for line, (first, last), weight in zip(lines, spans, owned, strict=True):
        found.append(Piece(words(line.text, line.end - line.start), first, weight[first:last]))
    return found, frames


def _line(item: Item, clock: float, name: str) -> Line:
    given = _as_mapping(item, name)
    text = checked_text(given["text"])
    if "from" not in given and "to" not in given:
        seconds = checked_number(given.get("seconds", SECONDS), f"{name}: seconds", SHORTEST_S, LONGEST_S)
        start, end = clock, clock + seconds
    else:
        start = checked_number(given.get("from", clock), f"{name}: from", 0.0, 1e6)
        length = given.get("seconds", SECONDS)
        end = checked_number(given.get("to", start + float(length)), f"{name}: to", 0.0, 1e6)
        checked_number(round(end - start, 6), f"{name}: to - from", SHORTEST_S, LONGEST_S)
    parts = checked_parts(given["parts"]) if given.get("parts") is not None else None
    return Line(text, start, end, parts)


def _as_mapping(item: Item, name: str) -> dict[str, Any]:
    if isinstance(item, str):
        return {"text": item}
    if isinstance(item, Mapping):
        if unknown := sorted(set(map(str, item)) - set(_KEYS)):
            raise InvalidInputError(f"{name}: unknown key {', '.join(unknown)}; there are: {', '.join(_KEYS)}")
        if "text" not in item:
            raise InvalidInputError(f"{name}: 'text' is missing")
        return dict(item)
    if isinstance(item, Sequence) and len(item) == 2:
        return {"text": item[0], "seconds": item[1]}
    raise InvalidInputError(f"{name}: give a text, a (text, seconds), or a mapping with: {', '.join(_KEYS)}")


def _check_covered(lines: Sequence[Line]) -> None:
    """Every moment belongs to a text that moves the whole body."""
    reached = 0.0
    for line in sorted((line for line in lines if line.parts is None), key=lambda line: line.start):
        if line.start > reached + 1e-6:
            break
        reached = max(reached, line.end)
    end = max(line.end for line in lines)
    if reached < end - 1e-6:
        raise InvalidInputError(
            f"no text moves the whole body at {reached:g} s; add one, as in ('stand', {end - reached:g}), without parts"
        )


def _span(line: Line, frames: int) -> tuple[int, int]:
    """First frame and the one behind the last that a line is denoised in, with what overlaps."""
    first, last = round(line.start * ego77.FPS), min(frames, round(line.end * ego77.FPS) + 1)
    more = min(OVERLAP, (NETWORK - (last - first)) // 2)
    return max(0, first - more), min(frames, last + more)


def _owned(line: Line, span: tuple[int, int], frames: int) -> FloatArray:
    """``(frames, 6)`` weights of a line, rising and falling over what overlaps."""
    first, last = span
    count = last - first
    ramp = np.arange(1, count + 1) / (2.0 * OVERLAP + 1)
    shape = np.ones(count)
    if first > 0:
        shape = np.minimum(shape, ramp)
    if last < frames:
        shape = np.minimum(shape, ramp[::-1])
    weight = np.zeros((frames, len(PARTS)), np.float32)
    moved = [line.parts is None or part in line.parts for part in PARTS]
    weight[first:last] = shape[:, None] * np.array(moved)
    return weight


def _give_way(lines: Sequence[Line], owned: Sequence[FloatArray]) -> None:
    """Whoever moves fewer parts has them to himself, as far as his weight goes; in place."""
    order = sorted(range(len(lines)), key=lambda k: (_count(lines[k]), -k))
    left = np.ones_like(owned[0])
    for level in sorted({_count(line) for line in lines}):
        same = [k for k in order if _count(lines[k]) == level]
        total = np.sum([owned[k] for k in same], axis=0)
        over = np.maximum(total, 1.0) if level < len(PARTS) + 1 else np.where(total > 0, total, 1.0)
        for k in same:
            owned[k][:] = owned[k] / over * left
        left = np.maximum(left - np.minimum(total, 1.0) * left, 0.0) if level < len(PARTS) + 1 else left


def _count(line: Line) -> int:
    """How many parts a line moves; one more than all for the whole body."""
    return len(PARTS) + 1 if line.parts is None else len(line.parts)
