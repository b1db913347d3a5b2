"""A part of a motion file as a file of the same kind: its own rig, channels and numbers, only fewer frames."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.acclaim.asf_search import find_asf
from motionrt.formats.atomic import write_atomically, write_bytes
from motionrt.formats.text import read_text
from motionrt.untrusted.npz import read_arrays, write_arrays

Span = tuple[int, int]


def can_cut(path: Path) -> bool:
    """Whether files of this kind can be cut as they are."""
    return path.suffix.lower() in _CUTTERS


def cut_file(source: Path, out: Path, first: int, stop: int, *, frames: int, fps: float) -> Path:
    """Write frames ``first`` to ``stop`` (exclusive) of a ``.bvh``, ``.amc`` (with its ``.asf``) or ``.npz`` file.

    Args:
        source: the file.
        out: where the part goes; the suffix is the source's.
        first: first frame of the part, in the motion that :func:`motionrt.load_motion` gives.
        stop: the frame behind its last.
        frames: how many frames the motion has; a calibration pose before them, which is not counted, is kept.
        fps: its frames per second, written into an ``.amc`` that does not say it.

    Raises:
        FormatError: the file is not what it was when it was loaded, or of a kind that cannot be cut.
    """
    cutter = _CUTTERS.get(source.suffix.lower())
    if cutter is None:
        raise FormatError(source, f"only {', '.join(_CUTTERS)} files can be cut as they are")
    cutter(source, out, (first, stop), frames, fps)
    return out


def _before(source: Path, there: int, frames: int) -> int:
    """Frames of the file before the first of the motion."""
    if there < frames:
        raise FormatError(source, f"it has {there} frames now, and had {frames} when it was loaded")
    return there - frames


def _cut_bvh(source: Path, out: Path, span: Span, frames: int, _fps: float) -> None:
    head, found, body = read_text(source).partition("MOTION")
    match = re.search(r"Frame\s+Time:\s*(\S+)\s*", body, re.IGNORECASE)
    if not found or match is None:
        raise FormatError(source, "it has no MOTION section")
    lines = [line for line in body[match.end() :].splitlines() if line.strip()]
    skip = _before(source, len(lines), frames)
    kept = lines[:skip] + lines[skip + span[0] : skip + span[1]]
    told = f"{head}MOTION\nFrames: {len(kept)}\nFrame Time: {match.group(1)}\n"
    write_bytes(out, (told + "\n".join(kept) + "\n").encode("utf-8"))


def _cut_amc(source: Path, out: Path, span: Span, frames: int, fps: float) -> None:
    lines = read_text(source).splitlines()
    starts = [number for number, line in enumerate(lines) if line.strip().isdigit()]
    skip = _before(source, len(starts), frames)
    bounds = [*starts, len(lines)]
    kept = lines[: starts[0]]
    if not any(line.strip().upper().startswith(":SAMPLES-PER-SECOND") for line in kept):
        kept.append(f":SAMPLES-PER-SECOND {fps:g}")
    for count, frame in enumerate([*range(skip), *range(skip + span[0], skip + span[1])], 1):
        kept += [str(count), *lines[bounds[frame] + 1 : bounds[frame + 1]]]
    write_bytes(out, ("\n".join(kept) + "\n").encode("utf-8"))
    shutil.copyfile(find_asf(source).path, out.with_suffix(".asf"))


def _cut_npz(source: Path, out: Path, span: Span, frames: int, _fps: float) -> None:
    arrays, _ = read_arrays(source, lambda reason, line: FormatError(source, reason, line))
    there = max((len(a) for a in arrays.values() if a.ndim > 1), default=0)
    skip = _before(source, there, frames)
    part = slice(skip + span[0], skip + span[1])
    cut = {name: a[part] if a.ndim and len(a) == there else a for name, a in arrays.items()}
    write_atomically(out, lambda file: write_arrays(file, cut))


_CUTTERS: dict[str, Callable[[Path, Path, Span, int, float], None]] = {
    ".bvh": _cut_bvh,
    ".amc": _cut_amc,
    ".npz": _cut_npz,
}
