"""Grey images as arrays: PGM by hand, everything else through Pillow."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import SceneError
from motionrt.locomotion.scene.optional import require_scene_file, scene_package

Grey = npt.NDArray[np.float64]

_HEADER = re.compile(rb"P([25])" + rb"(?:\s+|\s*#[^\n]*\n\s*)+(\d+)" * 3 + rb"(?:\s*#[^\n]*\n|\s)")
_MOST_PIXELS = 400_000_000


def read_grey(path: Path) -> Grey:
    """The grey values ``(H, W)`` of an image in 0..255, top row first; NaN where it is transparent."""
    require_scene_file(path)
    return _read_pgm(path) if path.suffix.lower() == ".pgm" else _read_with_pillow(path)


def _read_pgm(path: Path) -> Grey:
    """A portable grey map, plain (P2) or binary (P5), 8 or 16 bit."""
    data = path.read_bytes()
    header = _HEADER.match(data)
    if header is None:
        raise SceneError(f"{path} is not a PGM image: expected a header P2 or P5 with width, height and largest value")
    kind, width, height, largest = (int(word) for word in header.groups())
    if not (0 < largest < 65536 and 0 < width * height <= _MOST_PIXELS):
        raise SceneError(f"{path}: {width} x {height} pixels up to {largest} is no map that can be read")
    body = data[header.end() :]
    pixels = (
        _plain(body, path)
        if kind == 2
        else np.frombuffer(body, ">u2" if largest > 255 else "u1", _whole(body, largest))
    )
    if len(pixels) < width * height:
        raise SceneError(f"{path} ends after {len(pixels)} of {width * height} pixels: the file is cut off")
    grey = pixels[: width * height].reshape(height, width).astype(np.float64)
    return np.asarray(np.minimum(grey, largest) * (255.0 / largest))


def _whole(body: bytes, largest: int) -> int:
    """How many whole pixels there are."""
    return len(body) // (2 if largest > 255 else 1)


def _plain(body: bytes, path: Path) -> npt.NDArray[np.int64]:
    words = re.sub(rb"#[^\n]*", b"", body).split()
    try:
        return np.fromiter(map(int, words), dtype=np.int64, count=len(words))
    except ValueError as error:
        raise SceneError(f"{path} holds a pixel that is not a whole number") from error


def _read_with_pillow(path: Path) -> Grey:
    """Colours are averaged."""
    pillow = scene_package("PIL.Image", f"reading {path.name}")
    try:
        with pillow.open(path) as image:
            deep = image.mode.startswith("I")
            pixels = np.asarray(image if deep else image.convert("RGBA"), dtype=np.float64)
    except (OSError, ValueError, SyntaxError) as error:
        raise SceneError(f"{path} cannot be read as an image: {error}") from error
    if deep:
        return np.asarray(pixels * (255.0 / 65535.0))
    return np.where(pixels[..., 3] < 128, np.nan, pixels[..., :3].mean(axis=-1))
