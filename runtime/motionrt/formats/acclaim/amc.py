"""Acclaim AMC: the motion of an ASF skeleton."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.acclaim.asf import AsfSkeleton, read_asf
from motionrt.formats.acclaim.asf_search import find_asf, find_fps
from motionrt.formats.acclaim.rig import Values, build_rig
from motionrt.formats.text import read_text, shorten, to_float, to_floats
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.files import as_path

_RATE = re.compile(r":(?:samples?[-_ ]?per[-_ ]?second|frames?[-_ ]?per[-_ ]?second|fps|frame[-_ ]?rate)[ \t:=]+(\S+)")


@dataclass(frozen=True)
class _Body:
    """The lines of an AMC file after its header."""

    lines: list[str]
    first_line: int
    degrees: bool | None
    fps: float | None
    notes: tuple[str, ...] = ()


def read_amc(path: str | Path, asf: str | Path | None = None, *, fps: float | None = None) -> RigClip:
    """Read an AMC file with its ASF skeleton.

    A joint carries the name of the bone that *starts* at it (``lfemur`` is the left hip); the end of a last
    bone is the leaf ``<bone>_end``. A bone turns by ``C M C^-1``, with ``C`` its axes and ``M`` its channels.
    Y is up.

    Args:
        path: the ``.amc`` file.
        asf: the ``.asf`` skeleton; looked for beside the file if ``None``, see :func:`find_asf`.
        fps: frames per second; if ``None``, what the header says (``:SAMPLES-PER-SECOND``), else what
            :func:`find_fps` finds.

    Raises:
        MotionFileNotFoundError: the file is missing, or there is no skeleton for it.
        FormatError: either file is broken, or they do not belong together; names the line.
    """
    path = as_path(path)
    body = _read_body(path)
    skeleton = find_asf(path) if asf is None else read_asf(asf)
    layout = _first_frame(body, skeleton, path)
    body = _without_cut_frame(body, layout)
    channels = _read_frames(body, layout, path)
    channels = {_bone(name, skeleton): values for name, values in channels.items()}
    degrees = skeleton.angles_in_degrees if body.degrees is None else body.degrees
    rate = fps or body.fps or find_fps(path)
    return replace(build_rig(skeleton, channels, degrees, float(rate)), notes=body.notes)


def _read_body(path: Path) -> _Body:
    lines = read_text(path).split("\n")
    degrees: bool | None = None
    fps: float | None = None
    for i, line in enumerate(lines):
        word = line.strip().lower()
        if word.isdecimal():
            return _Body(lines[i:], i + 1, degrees, fps)
        if word in (":degrees", ":radians"):
            degrees = word == ":degrees"
        elif word.startswith(":"):
            fps = _stated_rate(word, path, i + 1) or fps
        elif word and word[0] != "#":
            raise FormatError(path, f"expected a frame number, found '{shorten(line)}'", i + 1)
    raise FormatError(path, "the file has no frames", len(lines))


def _stated_rate(line: str, path: Path, number: int) -> float | None:
    """Frames per second of a header line such as ``:samples-per-second 30``; ``None`` if it states something else."""
    match = _RATE.match(line)
    if match is None:
        return None
    rate = to_float(match.group(1), path, number)
    if not 1 <= rate <= 1000:
        raise FormatError(path, f"{shorten(match.group(1))} frames per second is no sane rate", number)
    return rate


def _without_cut_frame(body: _Body, layout: list[tuple[str, int]]) -> _Body:
    """Without the last frame of an interrupted export, which begins as the first one does and then ends."""
    starts = [i for i, line in enumerate(body.lines) if line.strip().isdecimal()]
    last = [line.split() for line in body.lines[starts[-1] + 1 :] if line.strip()]
    ends = [(words[0], len(words) - 1) for words in last]
    whole, rest = ends[:-1], ends[-1:]
    cut = ends != layout and whole == layout[: len(whole)] and len(whole) < len(layout)
    name, count = layout[len(whole)] if cut else ("", 0)
    if len(starts) < 2 or not cut or any(not name.startswith(word) or values > count for word, values in rest):
        return body
    note = f"ends within frame {body.lines[starts[-1]].strip()}; the {len(starts) - 1} whole frames before it are read"
    return replace(body, lines=body.lines[: starts[-1]], notes=(note,))


def _bone(name: str, skeleton: AsfSkeleton) -> str:
    """The skeleton's bone of that name, however its letters are written."""
    if name in skeleton.bones:
        return name
    alike = [bone for bone in skeleton.bones if bone.lower() == name.lower()]
    return alike[0] if len(alike) == 1 else name


def _read_frames(body: _Body, layout: list[tuple[str, int]], path: Path) -> dict[str, Values]:
    """Channel values ``(F, n)`` of every bone that the file moves."""
    words = " ".join(body.lines).split()
    width = 1 + sum(1 + count for _, count in layout)
    channels = _uniform_frames(words, layout, width) if len(words) % width == 0 else None
    return _frames_by_line(body, layout, path) if channels is None else channels


def _first_frame(body: _Body, skeleton: AsfSkeleton, path: Path) -> list[tuple[str, int]]:
    """Bones and channel counts of the first frame, held against the skeleton."""
    layout: list[tuple[str, int]] = []
    for number, line in enumerate(body.lines[1:], start=body.first_line + 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].isdecimal() and len(words) == 1:
            break
        _check_bone(words, skeleton, path, number)
        if any(words[0] == name for name, _ in layout):
            raise FormatError(path, f"bone '{words[0]}' twice in one frame", number)
        layout.append((words[0], len(words) - 1))
    if not any(name == "root" for name, _ in layout):
        raise FormatError(path, "the first frame has no root", body.first_line)
    return layout


def _check_bone(words: list[str], skeleton: AsfSkeleton, path: Path, line: int) -> None:
    bone = skeleton.bones.get(_bone(words[0], skeleton))
    if bone is None:
        raise FormatError(path, f"{skeleton.path.name} has no bone '{shorten(words[0])}'", line)
    if len(words) - 1 != len(bone.dof):
        expected = f"{skeleton.path.name} gives it {len(bone.dof)} channels"
        raise FormatError(path, f"'{bone.name}' has {len(words) - 1} values, but {expected}", line)


def _uniform_frames(words: list[str], layout: list[tuple[str, int]], width: int) -> dict[str, Values] | None:
    """All frames at once where each is laid out like the first and nothing is wrong, else ``None``."""
    frames = len(words) // width
    numbers: list[Values] = []
    at, columns = 1, {}
    for name, count in layout:
        if words[at::width].count(name) != frames:
            return None
        columns[name] = slice(len(numbers), len(numbers) + count)
        for i in range(at + 1, at + 1 + count):
            values = to_floats(words[i::width])
            if values is None:
                return None
            numbers.append(values)
        at += 1 + count
    order = to_floats(words[::width])
    if order is None or not (np.diff(order) == 1).all():
        return None
    table = np.stack(numbers, axis=-1)
    return {name: table[:, part] for name, part in columns.items()}


def _frames_by_line(body: _Body, layout: list[tuple[str, int]], path: Path) -> dict[str, Values]:
    """The patient way: comments between frames, bones in any order; finds the line that is wrong."""
    counts = dict(layout)
    frames: list[dict[str, list[float]]] = []
    last, start = None, body.first_line
    for line, raw in enumerate(body.lines, start=body.first_line):
        words = raw.split("#")[0].split()
        if not words:
            continue
        if len(words) == 1 and words[0].isdecimal():
            if frames:
                _check_complete(frames[-1], counts, path, start)
            if last is not None and int(words[0]) != last + 1:
                reason = f"frame {shorten(words[0])} follows frame {last}: frames are missing"
                raise FormatError(path, reason, line)
            last, start = int(words[0]), line
            frames.append({})
            continue
        name = words[0]
        if name not in counts or name in frames[-1]:
            what = "twice in one frame" if name in counts else "is not in the first frame"
            raise FormatError(path, f"bone '{shorten(name)}' {what}", line)
        if len(words) - 1 != counts[name]:
            raise FormatError(path, f"'{name}' has {len(words) - 1} values instead of {counts[name]}", line)
        frames[-1][name] = [to_float(word, path, line) for word in words[1:]]
    _check_complete(frames[-1], counts, path, start)
    return {name: np.array([frame[name] for frame in frames]) for name in counts}


def _check_complete(frame: dict[str, list[float]], counts: dict[str, int], path: Path, line: int) -> None:
    missing = [name for name in counts if name not in frame]
    if missing:
        reason = f"the frame that starts here lacks {', '.join(missing[:5])}: is the file cut off?"
        raise FormatError(path, reason, line)
