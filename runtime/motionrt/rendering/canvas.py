"""``Canvas``: a picture that is drawn several times too large and then shrunk, so that edges are smooth."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from motionrt.rendering.colours import Colours
from motionrt.rendering.pillow import pillow
from motionrt.rendering.solids import Floats, Solids, draw

Box = tuple[float, float, float, float]


class Canvas:
    """A picture of ``width`` by ``height`` pixels.

    Args:
        width, height: pixels of the result. All other numbers count pixels of :attr:`image`, which is ``fine`` times
            as large, except for text, which is drawn last, on the result.
        colours: of the picture.
        fine: how many times as large it is drawn.
    """

    def __init__(self, width: int, height: int, colours: Colours, fine: int) -> None:
        self.width, self.height, self.fine, self.colours = width, height, fine, colours
        self.image = pillow("Image").new("RGB", (width * fine, height * fine), colours.rgb("background"))
        self._pen = pillow("ImageDraw").Draw(self.image)
        self._texts: list[tuple[float, float, str, float, str, str, bool]] = []

    def polygon(self, points: Floats, colour: str) -> None:
        """Fill a polygon ``(N, 2)``."""
        if len(points) > 2:
            self._pen.polygon(points[:, :2].ravel().tolist(), fill=self.colours.rgb(colour))

    def line(self, points: Floats, colour: str, width: float, dashes: int = 0, fade: float = 0.0) -> None:
        """Draw a polyline ``(N, 2)``; with ``dashes``, that many points on and as many off; ``fade`` makes it paler."""
        wide = max(1, round(width * self.fine))
        shown = tuple(round(255 * float(part)) for part in self.colours.tones((colour,), fade)[0])
        step = dashes or max(len(points), 2)
        for start in range(0, len(points) - 1, 2 * step if dashes else step):
            part = points[start : start + step + 1, :2].ravel().tolist()
            self._pen.line(part, fill=shown, width=wide, joint="curve")

    def shade(self, discs: Floats, softness: float, strength: float = 0.30) -> None:
        """Darken where polygons ``(N, K, 2)`` are, with edges ``softness`` wide."""
        low, high = discs.min(axis=(0, 1)) - 3 * softness, discs.max(axis=(0, 1)) + 3 * softness
        size = self.image.size
        left, top = (int(v) for v in np.clip(np.floor(low), 0, size))
        right, bottom = (int(v) for v in np.clip(np.ceil(high), 0, size))
        if left >= right or top >= bottom:
            return
        half = 0.5  # a blurred shape needs no fine pixels
        shape = (max(1, round((right - left) * half)), max(1, round((bottom - top) * half)))
        mask = pillow("Image").new("L", shape, 0)
        pen = pillow("ImageDraw").Draw(mask)
        for disc in (discs - np.array([left, top], np.float32)) * half:
            pen.polygon(disc.ravel().tolist(), fill=round(255 * strength))
        mask = mask.filter(pillow("ImageFilter").GaussianBlur(max(softness * half, 0.1)))
        mask = mask.resize((right - left, bottom - top), pillow("Image").Resampling.BILINEAR)
        self.image.paste(self.colours.rgb("shadow"), (left, top, right, bottom), mask)

    def solids(self, solids: Solids) -> None:
        """Draw solids, the nearer ones before the others."""
        sprite = draw(solids, *self.image.size)
        if sprite is not None:
            image = pillow("Image")
            self.image.paste(image.fromarray(sprite.rgb), (sprite.left, sprite.top), image.fromarray(sprite.mask))

    def text(
        self,
        x: float,
        y: float,
        words: str,
        size: float,
        colour: str = "text",
        anchor: str = "la",
        *,
        halo: bool = False,
    ) -> None:
        """Write words at a pixel of the image; ``size`` in pixels of the result, ``anchor`` as Pillow has it.

        A ``halo`` of the background keeps words readable that stand before something.
        """
        self._texts.append((x / self.fine, y / self.fine, words, size, colour, anchor, halo))

    def finished(self) -> Any:
        """The picture, shrunk, with its texts: a ``PIL.Image`` in RGB."""
        small = self.image.reduce(self.fine) if self.fine > 1 else self.image
        pen = pillow("ImageDraw").Draw(small)
        for x, y, words, size, colour, anchor, halo in self._texts:
            around = {"stroke_width": 2, "stroke_fill": self.colours.rgb("floor")} if halo else {}
            pen.text((x, y), words, fill=self.colours.rgb(colour), font=font(size), anchor=anchor, **around)
        return small


@cache
def font(size: float) -> Any:
    """The font that comes with Pillow."""
    return pillow("ImageFont").load_default(size)


def shortened(words: str, size: float, width: float) -> str:
    """Words on one line that fit into so many pixels, cut with an ellipsis otherwise."""
    words, letters = " ".join(words.split()), font(size)
    if letters.getlength(words) <= width:
        return words
    cut = words
    while cut and letters.getlength(cut + "...") > width:
        cut = cut[:-1]
    return cut.rstrip() + "..."


def joined(parts: Sequence[Solids]) -> Solids:
    """All solids together."""
    return Solids(
        np.concatenate([part.ends for part in parts]),
        np.concatenate([part.radii for part in parts]),
        np.concatenate([part.colours for part in parts]),
        tuple(mesh for part in parts for mesh in part.meshes),
    )
