"""BVH in: one file as a :class:`RigClip`, or one error with file, line and reason."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.bvh.hierarchy import BvhJoint, parse_hierarchy
from motionrt.formats.bvh.rig import build_rig
from motionrt.formats.bvh.values import Values, read_values
from motionrt.formats.text import line_of, read_text, shorten
from motionrt.motion.checks import checked_fps
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.files import as_path

FPS_RANGE = (1.0, 1000.0)
"""Frame rates outside of this range are taken for a mistake in the file."""

_STILL_FPS = 30.0
_MOTION = re.compile(r"^[ \t]*MOTION\b", re.MULTILINE | re.IGNORECASE)
_COUNT = re.compile(r"\s*Frames[ \t]*:[ \t]*(\S*)", re.IGNORECASE)
_TIME = re.compile(r"\s*Frames?[ \t]*Time[ \t]*:[ \t]*(\S*)", re.IGNORECASE)
_COMMA = re.compile(r"(?<=\d),(?=\d)")


def read_bvh(path: str | Path, *, fps: float | None = None) -> RigClip:
    """Read a BVH file.

    Rotation channels may come in any order and number and are applied as listed (intrinsic, degrees).
    Position channels *replace* the joint's OFFSET on their axis, as in Blender; only where a file plainly
    holds differences (positions near zero at joints with a real offset) are they added to it. A frame may be
    broken over several lines. A second joint of a name is called ``<name>_2``. Unit and vertical axis are not
    part of the format: both stay ``None``.

    Args:
        path: the file; UTF-8 or Latin-1.
        fps: frames per second to use instead of the file's ``Frame Time``. A file of a single frame whose
            frame time makes no sense gets 30.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: the file is not a whole, finite BVH file; names the line.
    """
    bvh = parse_bvh(path, fps=fps)
    return replace(build_rig(bvh.joints, bvh.values, bvh.fps), notes=bvh.notes)


@dataclass(frozen=True, eq=False)
class BvhText:
    """A BVH file, parsed but not yet understood.

    Attributes:
        hierarchy: its text up to MOTION.
        joints: what that declares.
        values: ``(F, C)`` channel values.
        fps: frames per second.
        notes: what in the file was not taken at its word.
    """

    hierarchy: str
    joints: list[BvhJoint]
    values: Values
    fps: float
    notes: tuple[str, ...] = ()


def parse_bvh(path: str | Path, *, fps: float | None = None) -> BvhText:
    """Text, joints and numbers of a BVH file; arguments and errors as for :func:`read_bvh`."""
    path = as_path(path)
    text = _with_points(read_text(path))
    start = _MOTION.search(text)
    joints = parse_hierarchy(text[: start.start()] if start else text, path)
    if start is None:
        raise FormatError(path, "the file ends before MOTION", line_of(text, len(text)))
    return BvhText(text[: start.start()], joints, *_read_motion(text, start.end(), joints, path, fps))


def _with_points(text: str) -> str:
    """``text`` with decimal points where all its numbers have decimal commas, and blanks where commas divide them."""
    start = text.find("MOTION")
    numbers = text[start:]
    if "," not in numbers and ";" not in numbers:
        return text
    if "." not in numbers:
        return _COMMA.sub(".", text).replace(";", " ")
    return text[:start] + numbers.replace(",", " ").replace(";", " ")


def _read_motion(
    text: str, at: int, joints: list[BvhJoint], path: Path, fps: float | None
) -> tuple[Values, float, tuple[str, ...]]:
    """Channel values ``(F, C)``, the frame rate, and notes on what the file says otherwise."""
    channels = sum(len(joint.channels) for joint in joints)
    if channels == 0:
        raise FormatError(path, "no joint has CHANNELS: there is no motion in this file", line_of(text, at))
    word, at = _header_field(_COUNT, "Frames:", text, at, path)
    frames = _frame_count(word, path, line_of(text, at))
    if fps is None or _TIME.match(text, at):
        word, at = _header_field(_TIME, "Frame Time:", text, at, path)
    rate = checked_fps(fps) if fps is not None else _frame_rate(word, frames, path, line_of(text, at))
    values, notes = read_values(text, at, (frames, channels), path)
    return values, rate, notes


def _header_field(pattern: re.Pattern[str], name: str, text: str, at: int, path: Path) -> tuple[str, int]:
    match = pattern.match(text, at)
    if match is None:
        rest = text[at:].lstrip()
        found = shorten(rest[:200].split("\n")[0]) if rest else "the end of the file"
        raise FormatError(path, f"expected '{name}', found '{found}'", line_of(text, len(text) - len(rest)))
    return match.group(1), match.end()


def _frame_count(word: str, path: Path, line: int) -> int:
    if not (word.isascii() and word.isdecimal() and len(word) < 10):
        raise FormatError(path, f"the number of frames is '{shorten(word)}'", line)
    return int(word)


def _frame_rate(word: str, frames: int, path: Path, line: int) -> float:
    slow, fast = FPS_RANGE
    try:
        seconds = float(word)
    except ValueError:
        raise FormatError(path, f"frame time '{shorten(word)}' is not a number", line) from None
    if math.isfinite(seconds) and seconds > 0 and slow <= 1 / seconds <= fast:
        return _snap(1 / seconds)
    if frames == 1:
        return _STILL_FPS
    expected = f"between {1 / fast:g} and {1 / slow:g} s; give fps= to replace it"
    raise FormatError(path, f"frame time {shorten(word)} is not {expected}", line)


def _snap(fps: float) -> float:
    """The whole number that a rounded frame time stands for (0.016667 s is 60 fps), where there is one."""
    return float(round(fps)) if abs(round(fps) / fps - 1) < 1e-4 else fps
