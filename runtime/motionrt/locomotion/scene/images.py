"""Grey images as arrays: PGM by hand, everything else through Pillow."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.optional import require_scene_file, scene_package
from motionrt.untrusted.files import read_bytes
from motionrt.untrusted.words import shorten

Grey = npt.NDArray[np.float32]

_FORMATS = ("PNG", "BMP", "JPEG", "TIFF", "PPM")
_SPACE = b" \t\r\n\v\f"
_HEADER_BYTES = 64 * 1024


def read_grey(path: Path) -> Grey:
    """The grey values ``(H, W)`` of an image in 0..255, top row first; NaN where it is transparent.

    Raises:
        SceneError: it cannot be read, or has more pixels than ``motionrt.limits`` allows.
    """
    require_scene_file(path)
    return _read_pgm(path) if path.suffix.lower() == ".pgm" else _read_with_pillow(path)


def _read_pgm(path: Path) -> Grey:
    """A portable grey map, plain (P2) or binary (P5), 8 or 16 bit."""
    data = read_bytes(path, lambda reason, _: SceneError(f"{path} {reason}"))
    header = _header(data)
    if header is None:
        raise SceneError(f"{path} is not a PGM image: expected a header P2 or P5 with width, height and largest value")
    kind, width, height, largest, start = header
    if not (0 < largest < 65536 and width > 0 and height > 0):
        raise SceneError(f"{path}: {width} x {height} pixels up to {largest} is no map that can be read")
    _check_size(path, width, height)
    form = np.dtype(">u2" if largest > 255 else "u1")
    if kind == 2:
        pixels = _plain(data[start:], path, width * height)
    else:
        pixels = np.frombuffer(data, form, (len(data) - start) // form.itemsize, start)
    if len(pixels) < width * height:
        raise SceneError(f"{path} ends after {len(pixels)} of {width * height} pixels: the file is cut off")
    grey = pixels[: width * height].reshape(height, width).astype(np.float32)
    return np.asarray(np.minimum(grey, largest) * np.float32(255.0 / largest))


def _check_size(path: Path, width: int, height: int) -> None:
    if width * height > limits().pixels:
        raise SceneError(f"{path} has {width} x {height} pixels: {how_to_raise('pixels')}")


def _header(data: bytes) -> tuple[int, int, int, int, int] | None:
    """Kind, width, height, largest value, and where the pixels begin; None if it is no PGM file."""
    if data[:2] not in (b"P2", b"P5"):
        return None
    numbers: list[int] = []
    at, end = 2, min(len(data), _HEADER_BYTES)
    while at < end and len(numbers) < 3:
        if data[at] in _SPACE:
            at += 1
        elif data[at] == ord("#"):
            at = (data.find(b"\n", at, end) + 1) or end
        else:
            word = data[at : at + 10].split(maxsplit=1)[0].partition(b"#")[0]
            if not word.isdigit() or len(word) > 9 or data[at - 1] not in _SPACE:
                return None
            numbers.append(int(word))
            at += len(word)
    if len(numbers) < 3:
        return None
    line = data[at:end].partition(b"\n")[0]
    if line.lstrip(_SPACE).startswith(b"#"):
        at += len(line)
    return int(data[1:2]), *numbers, min(at + 1, len(data))  # type: ignore[return-value]


def _plain(body: bytes, path: Path, count: int) -> npt.NDArray[np.int64]:
    lines = (line.partition(b"#")[0] for line in body.split(b"\n"))
    words = b" ".join(lines).split(None, count)[:count]
    try:
        values = np.array(words, dtype="S12").astype(np.int64)
    except (ValueError, OverflowError) as error:
        raise SceneError(f"{path} holds a pixel that is not a whole number") from error
    if len(values) and values.min() < 0:
        raise SceneError(f"{path} holds a pixel below 0")
    return values


def _read_with_pillow(path: Path) -> Grey:
    """Colours are averaged."""
    pillow = scene_package("PIL.Image", f"reading {path.name}")
    try:
        with pillow.open(path, formats=_FORMATS) as image:
            _check_size(path, *image.size)
            deep = image.mode.startswith("I")
            pixels = np.asarray(image if deep else image.convert("RGBA"))
    except SceneError:
        raise
    except (OSError, ValueError, SyntaxError, EOFError, IndexError, KeyError, TypeError, struct.error) as error:
        # what Pillow raises for files that are damaged
        raise SceneError(f"{path} cannot be read as an image: {shorten(str(error), 200)}") from error
    except pillow.DecompressionBombError as error:
        raise SceneError(f"{path} is too large an image: {how_to_raise('pixels')}") from error
    if deep:
        return np.asarray(pixels * np.float32(255.0 / 65535.0), dtype=np.float32)
    grey = pixels[..., 0].astype(np.float32)
    grey += pixels[..., 1]
    grey += pixels[..., 2]
    grey /= 3
    grey[pixels[..., 3] < 128] = np.nan
    return grey
