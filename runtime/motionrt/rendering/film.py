"""Animations: clips side by side, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from motionrt.rendering.camera import Camera
from motionrt.rendering.canvas import Canvas, shortened
from motionrt.rendering.framing import cameras
from motionrt.rendering.look import Look
from motionrt.rendering.scenery import paint
from motionrt.rendering.takes import Take

SIDE, COLUMNS, FINE = 400, 3, 2


def film(takes: list[Take], look: Look, fps: float) -> Iterator[Any]:
    """The pictures of an animation, each a ``PIL.Image``; as long as the longest clip, others stay at their end."""
    width, height = sheet(len(takes), look)
    count = max(1, round(max(take.motion.duration for take in takes) * fps))
    columns = _columns(len(takes), look)
    rows = -(-len(takes) // columns)
    room = (width // columns, height // rows)
    panels = [_Panel(take, look, *room, fps, count) for take in takes]
    image = Canvas(width, height, look.palette, 1).finished()
    for number in range(count):
        for place, panel in enumerate(panels):
            image.paste(panel.picture(number), (place % columns * room[0], place // columns * room[1]))
        yield image.copy()


def sheet(clips: int, look: Look) -> tuple[int, int]:
    """Pixels (width, height) of an animation, both even, as video wants them."""
    columns = _columns(clips, look)
    rows = -(-clips // columns)
    width, height = look.size or (SIDE * columns, SIDE * rows)
    height = height or width * rows // columns
    return width - width % 2, height - height % 2


def _columns(clips: int, look: Look) -> int:
    return min(look.columns or (clips if clips <= COLUMNS else COLUMNS if clips != 4 else 2), clips)


class _Panel:
    """One clip of an animation."""

    def __init__(self, take: Take, look: Look, width: int, height: int, fps: float, count: int) -> None:
        self.take, self.look, self.width, self.height = take, look, width, height
        self.text = float(np.clip(min(width, height) / 28, 10, 22))
        last = take.motion.frames - 1
        self.frames = np.minimum(np.round(np.arange(count) * take.motion.fps / fps).astype(int), last)
        top = (2.4 if take.caption else 0.8) * self.text
        bottom = height - (2.2 if look.times else 0.8) * self.text
        box = (self.text * FINE, top * FINE, (width - self.text) * FINE, bottom * FINE)
        self.cameras: list[Camera] = cameras(take, look, box, self.frames.tolist())

    def picture(self, number: int) -> Any:
        """The panel at a frame of the animation."""
        canvas = Canvas(self.width, self.height, self.look.palette, FINE)
        frame = int(self.frames[number])
        paint(canvas, self.cameras[number], self.take, self.look, [(frame, 0.0)])
        margin, text = 0.8 * self.text * FINE, self.text
        if self.take.caption:
            canvas.text(margin, margin, shortened(self.take.caption, 1.1 * text, self.width - 2 * text), 1.1 * text)
        if self.look.times:
            self._clock(canvas, frame)
        return canvas.finished()

    def _clock(self, canvas: Canvas, frame: int) -> None:
        """The time, and a bar of how much has passed."""
        motion, text = self.take.motion, self.text
        right, low = (self.width - 0.8 * text) * FINE, (self.height - 0.9 * text) * FINE
        left = (0.8 + 3.0) * text * FINE
        done = left + (right - left) * (frame + 1) / motion.frames
        canvas.text(0.8 * text * FINE, low, f"{frame / motion.fps:.1f} s", 0.9 * text, "faint", "lm")
        canvas.line(np.array([[left, low], [right, low]]), "grid", 2.0)
        canvas.line(np.array([[left, low], [done, low]]), "faint", 2.0)
