"""Poses where they happen: one picture of the scene, with the figure again and again along its way."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from motionrt.rendering.camera import Camera
from motionrt.rendering.canvas import Canvas, font, shortened
from motionrt.rendering.framing import cameras
from motionrt.rendering.look import Look
from motionrt.rendering.poses import Poses, along_the_way
from motionrt.rendering.scenery import paint
from motionrt.rendering.solids import Floats
from motionrt.rendering.strip import FINE, WIDTH
from motionrt.rendering.takes import Take

_ASPECT, _PALEST = 0.5, 0.55
_HEAD = 0.35  # of the height of a character
_FROM_ABOVE = 0.9  # sine of the elevation, from which times stand beside the figures


def places(takes: list[Take], look: Look) -> Any:
    """The picture, a ``PIL.Image``: early poses are pale, the last one is not; their times above them."""
    columns = min(look.columns or 1, len(takes))
    width, height = look.size or (WIDTH, 0)
    rows = -(-len(takes) // columns)
    room = (width // columns, (height // rows) or round(_ASPECT * width / columns))
    picture = Canvas(width, rows * room[1], look.palette, 1).finished()
    for number, take in enumerate(takes):
        part = _place(take, look, *room)
        picture.paste(part, (number % columns * room[0], number // columns * room[1]))
    return picture


def _place(take: Take, look: Look, width: int, height: int) -> Any:
    canvas = Canvas(width, height, look.palette, FINE)
    text = float(np.clip(width / 75, 9, 22))
    top = (2.2 if take.caption else 0.8) * text + (1.4 * text if look.times else 0)
    box = (text * FINE, top * FINE, (width - text) * FINE, (height - 0.8 * text) * FINE)
    camera = cameras(take, replace(look, follow=False), box, [0])[0]
    frames, words = along_the_way(take, look)
    fades = np.linspace(_PALEST, 0, len(frames)) if len(frames) > 1 else np.zeros(1)
    paint(canvas, camera, take, look, list(zip(frames.tolist(), fades.tolist(), strict=True)))
    if look.times:
        _words(canvas, camera, take, Poses(frames, words), 0.85 * text)
    if take.caption:
        canvas.text(text * FINE, 0.6 * text * FINE, shortened(take.caption, 1.15 * text, width - 2 * text), 1.15 * text)
    return canvas.finished()


def _words(canvas: Canvas, camera: Camera, take: Take, poses: Poses, size: float) -> None:
    """Words above the heads, on nobody's head; of two that would touch only the later one."""
    taken: list[tuple[float, float, float]] = []
    outlines = [camera.project(take.outline(frame))[0] for frame in poses.frames.tolist()]
    heads = np.array([_head(outline, camera, take) for outline in outlines])
    for joints, words in zip(outlines[::-1], poses.words[::-1], strict=True):
        above = 0.24 if take.character is None else 0.08
        x, y = float(joints[0, 0]), float(joints[:, 1].min()) - above * camera.scale
        if camera.turn[2][1] > _FROM_ABOVE:
            x, y = float(joints[:, 0].max()) + 0.45 * camera.scale, float(joints[0, 1])
        half = 0.5 * (font(size).getlength(words) + size) * canvas.fine
        tall = size * canvas.fine
        free = all(abs(x - a) > half + wide or abs(y - b) > 1.3 * tall for a, b, wide in taken)
        if words and free and not _covers((x - half, y - tall, x + half, y), heads):
            taken.append((x, y, half))
            canvas.text(x, y, words, size, "faint", "ms", halo=True)


def _head(outline: Floats, camera: Camera, take: Take) -> tuple[float, float, float, float]:
    """Pixels left, top, right, bottom of the head of somebody with that outline ``(N, 3)``, a little less of it."""
    top, low = float(outline[:, 1].min()), float(outline[:, 1].max())
    if take.character is None:
        x, top = float(outline[outline[:, 1].argmin(), 0]), top - 0.16 * camera.scale
        return x - 0.1 * camera.scale, top, x + 0.1 * camera.scale, top + 0.3 * camera.scale
    upper = outline[outline[:, 1] < top + _HEAD * (low - top), 0]
    return float(upper.min()), top, float(upper.max()), top + _HEAD * (low - top)


def _covers(box: tuple[float, float, float, float], heads: Floats) -> bool:
    """Whether a box of pixels lies on any of heads ``(N, 4)``."""
    left, top, right, bottom = box
    apart = (heads[:, 0] > right) | (heads[:, 2] < left) | (heads[:, 1] > bottom) | (heads[:, 3] < top)
    return not bool(apart.all())
