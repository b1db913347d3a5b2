"""Filmstrips: poses of a motion side by side, a row for each motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from motionrt.rendering import stage
from motionrt.rendering.body import SOLE
from motionrt.rendering.camera import Camera
from motionrt.rendering.canvas import Canvas, joined, shortened
from motionrt.rendering.look import Look
from motionrt.rendering.rows import FLOOR_DEPTH, Row, feet_of, row_of
from motionrt.rendering.scenery import trails
from motionrt.rendering.solids import Floats
from motionrt.rendering.takes import Take

WIDTH, FINE = 1600, 3
_LARGEST = 420.0  # pixels per metre


@dataclass(frozen=True)
class _Place:
    """Where a row comes to lie, in pixels of the canvas.

    Attributes:
        left: of the row.
        top: of the row.
        room: its width, in pixels of the result.
        first: x of the first pose.
        level: y of the floor.
        scale: pixels per metre.
        text: size of the letters, in pixels of the result.
    """

    left: float
    top: float
    room: float
    first: float
    level: float
    scale: float
    text: float


def filmstrip(takes: list[Take], look: Look) -> Any:
    """The picture, a ``PIL.Image``: poses at equal times from left to right, the time below each."""
    rows = [row_of(take, look) for take in takes]
    columns = min(look.columns or 1, len(rows))
    lines = [rows[first : first + columns] for first in range(0, len(rows), columns)]
    width, height = look.size or (WIDTH, 0)
    room = width / columns
    text = float(np.clip(room / 62, 10, 22))
    head = (2.0 if any(take.caption for take in takes) else 0.4) * text
    foot = (1.9 if look.times else 0.4) * text
    tops = [max(row.top for row in line) for line in lines]
    metres = [top + max(row.below for row in line) for top, line in zip(tops, lines, strict=True)]
    scale = min(room / max(row.width for row in rows), _LARGEST)
    if height:
        scale = min(scale, max(height - len(lines) * (head + foot), 16) / sum(metres))
    canvas = Canvas(width, height or round(sum(scale * m + head + foot for m in metres)), look.palette, FINE)
    at = 0.0
    for line, top, tall in zip(lines, tops, metres, strict=True):
        for column, row in enumerate(line):
            row.spread(room / scale)
            left, fine = column * room * FINE, scale * FINE
            first = left + (room * FINE - row.width * fine) / 2 + row.left * fine
            level = (at + head) * FINE + top * fine
            _draw(canvas, row, look, _Place(left, at * FINE, room, first, level, fine, text))
        at += scale * tall + head + foot
    return canvas.finished()


def _draw(canvas: Canvas, row: Row, look: Look, place: _Place) -> None:
    """One row: floor, shadows, trails, poses, words."""
    frames = row.poses.frames
    along = place.first + row.apart * place.scale * np.arange(len(frames))
    views = [replace(c, scale=place.scale, centre=(x, place.level)) for c, x in zip(row.cameras, along, strict=True)]
    if look.grid:
        _floor(canvas, row, place)
    for frame, view in zip(frames, views, strict=True) if look.shadow else ():
        stage.shadow(canvas, view, row.take, frame)
    if look.trails:
        trails(canvas, row.take, _ways(row, views[0], place))
    canvas.solids(joined([stage.body(view, row.take, f, look.palette) for f, view in zip(frames, views, strict=True)]))
    _write(canvas, row, look, place, along)


def _write(canvas: Canvas, row: Row, look: Look, place: _Place, along: Floats) -> None:
    """The caption above, and the words of the poses below."""
    text, fine = place.text, canvas.fine
    if row.take.caption:
        words = shortened(row.take.caption, 1.15 * text, place.room - 2 * text)
        canvas.text(place.left + 0.7 * text * fine, place.top + 0.5 * text * fine, words, 1.15 * text)
    below = place.level + row.below * place.scale + 0.25 * text * fine
    for words, x in zip(row.poses.words, along, strict=True) if look.times else ():
        canvas.text(x, below, words, 0.85 * text, "faint", "ma")


def _floor(canvas: Canvas, row: Row, place: _Place) -> None:
    """A band of floor below all poses."""
    half = FLOOR_DEPTH * abs(float(row.cameras[0].turn[2][1])) * place.scale
    middle = place.level + SOLE * place.scale
    left = place.first - (row.left - 0.1) * place.scale
    right = left + (row.width - 0.2) * place.scale
    far, near = middle - half, middle + half
    corners = [[left + 0.9 * half, far], [right - 0.9 * half, far], [right, near], [left, near]]
    canvas.polygon(np.array(corners), "floor")


def _ways(row: Row, view: Camera, place: _Place) -> Floats:
    """Pixels ``(F, J, 2)`` of all joints along the strip: every frame stands where its time is."""
    motion = row.take.motion
    local = motion.positions() - feet_of(row.take)[:, None]
    span = (len(row.cameras) - 1) * row.apart * place.scale
    pixels = view.at(np.zeros(3, np.float32)).project(local)[0][..., :2]
    pixels[..., 0] += np.linspace(0, span, motion.frames)[:, None]
    return np.asarray(pixels, np.float32)
