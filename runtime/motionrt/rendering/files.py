"""Pictures into files: .png, .jpg, .gif, .mp4."""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.rendering.colours import Colours
from motionrt.rendering.pillow import ffmpeg, pillow

PICTURES = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG", ".webp": "WEBP"}
FILMS = (".gif", ".mp4")
GIF_COLOURS, _SAMPLES, _SAME = 96, 12, 8
_FLAT = ("background", "floor", "grid", "text", "faint", "path")


def write_picture(image: Any, path: Path) -> Path:
    """Write a ``PIL.Image`` in the format that the suffix names."""
    kind = PICTURES[path.suffix.lower()]
    options = {"quality": 92} if kind != "PNG" else {"optimize": True}
    return write_atomically(path, lambda file: image.save(file, kind, **options))


def gif_rate(fps: float) -> float:
    """The rate nearest to ``fps`` that a .gif can have: whole hundredths of a second, and 25 at most."""
    return 100.0 / max(4, round(100.0 / fps))


def write_gif(images: Iterable[Any], path: Path, fps: float, colours: Colours) -> Path:
    """Write an animation that repeats for ever, with one palette and only what changes from frame to frame."""
    frames = list(images)
    palette = _palette(frames, colours)
    plain = pillow("Image").Dither.NONE
    small = (frame.quantize(palette=palette, dither=plain) for frame in frames)
    first, rest = next(small), small
    delay = round(1000 / fps)
    return write_atomically(
        path,
        lambda file: first.save(
            file, "GIF", save_all=True, append_images=rest, duration=delay, loop=0, optimize=False, disposal=1
        ),
    )


def _palette(frames: list[Any], colours: Colours) -> Any:
    """The flat colours exactly, then what else is in some frames from all over the animation, as an image in mode P."""
    some = frames[:: max(1, -(-len(frames) // _SAMPLES))]
    width, height = some[0].size
    sheet = pillow("Image").new("RGB", (width, height * len(some)))
    for number, frame in enumerate(some):
        sheet.paste(frame, (0, number * height))
    median = pillow("Image").Quantize.MEDIANCUT
    found = np.array(sheet.quantize(GIF_COLOURS, method=median).getpalette()).reshape(-1, 3)[:GIF_COLOURS]
    exact = np.concatenate([_flat(colours), _soft(colours)])
    apart = (
        np.abs(found[:, None] - exact).max(axis=2).min(axis=1) > _SAME
    )  # neighbours would be taken for the exact ones
    palette = pillow("Image").new("P", (1, 1))
    palette.putpalette(np.concatenate([exact, found[apart]]).ravel().tolist())
    return palette


def _flat(colours: Colours) -> npt.NDArray[np.int64]:
    return np.array([colours.rgb(name) for name in _FLAT])


def _soft(colours: Colours) -> npt.NDArray[np.int64]:
    """Shades of what is small or faint: shadows on the floor, and marks."""
    floor, shadow, mark = (np.array(colours.rgb(name)) for name in ("floor", "shadow", "mark"))
    shadows = [floor + part * (shadow - floor) for part in (0.06, 0.12, 0.18, 0.24, 0.30)]
    return np.round([*shadows, 0.6 * mark, 0.8 * mark, mark]).astype(np.int64)


def write_mp4(images: Iterator[Any], path: Path, fps: float) -> Path:
    """Write an H.264 video that browsers and players show, by ffmpeg.

    Raises:
        MissingDependencyError: ffmpeg is not there.
        InvalidInputError: ffmpeg cannot make the file; says why.
    """
    program = ffmpeg()
    first = next(images)
    width, height = first.size
    with tempfile.TemporaryDirectory() as folder:
        video = Path(folder) / "video.mp4"
        command = [
            program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
            "-r", f"{fps:g}", "-i", "-", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p",
            "-movflags", "+faststart", str(video),
        ]  # fmt: skip
        _run(command, chain([first], images))
        return write_atomically(path, lambda file: _copy(video, file))


def _run(command: list[str], images: Iterable[Any]) -> None:
    with tempfile.TemporaryFile() as complaints:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=complaints)
        stopped = False
        try:
            for image in images:
                process.stdin.write(image.tobytes())  # type: ignore[union-attr]
        except BrokenPipeError:
            stopped = True
        finally:
            _close(process)
        if process.wait() != 0 or stopped:
            complaints.seek(0)
            words = complaints.read().decode("utf-8", "replace").strip().splitlines()
            raise InvalidInputError(f"ffmpeg cannot make the video: {words[-1] if words else 'it stopped'}")


def _close(process: subprocess.Popen[bytes]) -> None:
    try:
        process.stdin.close()  # type: ignore[union-attr]
    except BrokenPipeError:
        return


def _copy(source: Path, file: BinaryIO) -> None:
    with source.open("rb") as video:
        while block := video.read(1 << 20):
            file.write(block)
