"""``Path``: a polyline on the ground plane, as an immutable value that says where along it anything is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as FilePath

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats.text import read_text, to_float
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.corners import round_corners
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import checked_array, checked_number
from motionrt.untrusted.files import as_path

_SAME_POINT = 1e-6
_BATCH = 1_000_000  # point-segment pairs that project() holds in memory at once


@dataclass(frozen=True, eq=False)
class Waypoints:
    """Places to walk to one after the other, each with the heading to arrive with.

    Attributes:
        positions: ``(N, 2)`` float32, (x, z) metres.
        headings: ``(N,)`` float32, yaw in radians from +Z towards +X.
    """

    positions: FloatArray
    headings: FloatArray

    def __len__(self) -> int:
        return len(self.positions)


@dataclass(frozen=True, eq=False)
class Path:
    """A polyline on the ground plane. Arc lengths count in metres from its start and are clipped to the path.

    Attributes:
        points: ``(N, 2)`` float32, (x, z) metres, read-only; a point that repeats the one before it is dropped.
        notes: what a planner had to tell about the path, in words.

    Raises:
        InvalidInputError: fewer than two different points, wrong shape, or numbers that are not finite.
    """

    points: FloatArray
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        with np.errstate(over="ignore"):  # infinity is refused below
            points = checked_array(self.points, "path points", "(x, z) in metres, one or more").astype(np.float32)
        if points.ndim != 2 or points.shape[1] != 2:
            raise InvalidInputError(f"path points must have the shape (N, 2), x and z in metres, not {points.shape}")
        if len(points) > limits().path_points:
            raise InvalidInputError(f"a path of {len(points):,} points is too long: {how_to_raise('path_points')}")
        if not np.isfinite(points).all():
            bad = int(np.argmin(np.isfinite(points).all(axis=1)))
            raise InvalidInputError(f"path points hold a number that is not finite, first in point {bad}")
        if np.abs(points).max(initial=0.0) > limits().metres:
            raise InvalidInputError(f"path points lie too far from the origin: {how_to_raise('metres')}")
        points = points[np.append(True, np.linalg.norm(np.diff(points, axis=0), axis=1) > _SAME_POINT)[: len(points)]]
        if len(points) < 2:
            raise InvalidInputError("a path needs at least two different points")
        points.setflags(write=False)
        object.__setattr__(self, "points", points)

    def __repr__(self) -> str:
        return f"Path({len(self.points)} points, {self.length:.2f} m)"

    @classmethod
    def from_csv(cls, file: str | FilePath) -> Path:
        """Read a file of two columns, x and z in metres, one point a line.

        Columns are parted by commas, semicolons, tabs or blanks; empty lines and ``#`` comments are skipped. A header
        may name the columns (``x`` and ``z``, in any place); without one the first two columns are x and z.

        Raises:
            MotionFileNotFoundError: there is no such file.
            FormatError: a line cannot be read, or there are not two different points; names file and line.
        """
        path = as_path(file)
        if not path.exists():
            raise MotionFileNotFoundError(f"no such file: {path}")
        rows = [(n, _cells(line)) for n, line in enumerate(read_text(path).split("\n"), start=1) if _cells(line)]
        columns, rows = _columns(rows, path)
        points = [[_number(row, column, path, n) for column in columns] for n, row in rows]
        try:
            return cls(np.array(points, dtype=np.float32).reshape(-1, 2))
        except InvalidInputError as error:
            raise FormatError(path, str(error)) from error

    @cached_property
    def _steps(self) -> npt.NDArray[np.float64]:
        return np.diff(self.points.astype(np.float64), axis=0)

    @cached_property
    def _marks(self) -> npt.NDArray[np.float64]:
        """Arc length ``(N,)`` at every point."""
        return np.append(0.0, np.cumsum(np.linalg.norm(self._steps, axis=1)))

    @property
    def length(self) -> float:
        """Metres from start to end along the path."""
        return float(self._marks[-1])

    def at(self, s: npt.ArrayLike) -> FloatArray:
        """The places ``[..., 2]`` at arc lengths ``s`` ``[...]`` metres."""
        where = _arc(s)
        axes = [np.interp(where, self._marks, self.points[:, axis]) for axis in (0, 1)]
        return np.stack(axes, axis=-1).astype(np.float32)

    def tangent(self, s: npt.ArrayLike) -> FloatArray:
        """Unit directions ``[..., 2]`` at arc lengths ``s`` ``[...]``; at a corner that of the way ahead."""
        index = np.searchsorted(self._marks, _arc(s), side="right") - 1
        steps = self._steps[np.clip(index, 0, len(self._steps) - 1)]
        return np.asarray(steps / np.linalg.norm(steps, axis=-1, keepdims=True), dtype=np.float32)

    def project(self, xz: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """The nearest place on the path of every point ``[..., 2]``: its arc length ``[...]``, and how far it is.

        Where the path crosses itself the earlier of two equally near places wins.
        """
        points = checked_array(xz, "points to project", "numbers, (..., 2)")
        if points.shape[-1:] != (2,):
            raise InvalidInputError(f"points to project must have the shape (..., 2), not {points.shape}")
        flat = points.reshape(-1, 2)
        parts = np.array_split(flat, max(1, len(flat) * len(self._steps) // _BATCH))
        arc, distance = np.concatenate([self._project(part) for part in parts]).T.astype(np.float32)
        return arc.reshape(points.shape[:-1]), distance.reshape(points.shape[:-1])

    def _project(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Arc length and distance, ``(N, 2)``, of points ``(N, 2)``."""
        squares = (self._steps**2).sum(axis=1)
        offsets = points[:, None] - self.points[None, :-1]
        along = np.clip((offsets * self._steps).sum(axis=-1) / squares, 0, 1)
        distance = np.linalg.norm(offsets - along[..., None] * self._steps, axis=-1)
        best = distance.argmin(axis=1)
        rows = np.arange(len(points))
        return np.stack([self._marks[best] + along[rows, best] * np.sqrt(squares[best]), distance[rows, best]], axis=1)

    def waypoints(self, spacing: float) -> Waypoints:
        """Evenly spaced places along the path, at most ``spacing`` metres apart, headed along it.

        The start is not among them, the end is the last one.
        """
        if checked_number(spacing, "the spacing of waypoints") <= 0:
            raise InvalidInputError(f"the spacing of waypoints must be a positive number of metres, not {spacing}")
        count = max(1, int(np.ceil(self.length / spacing - 1e-6)))
        s = np.linspace(0, self.length, count + 1)[1:]
        ahead = self.tangent(s)
        return Waypoints(self.at(s), np.arctan2(ahead[:, 0], ahead[:, 1]))

    def part(self, start: float, end: float) -> Path:
        """The piece between two arc lengths in metres."""
        start, end = checked_number(start, "start"), checked_number(end, "end")
        inner = (self._marks > start) & (self._marks < end)
        return Path(np.concatenate([self.at([start]), self.points[inner], self.at([end])]), self.notes)

    def rounded(self, radius: float = 0.8) -> Path:
        """With corners turned into arcs of up to ``radius`` metres, smaller where the legs are short.

        This knows nothing of walls: paths from :meth:`Scene.plan` are rounded already, and stay clear of them.
        """
        radius = checked_number(radius, "radius", 0.0)
        return Path(round_corners(self.points, [(radius, lambda _: True)]).astype(np.float32), self.notes)


def _arc(s: npt.ArrayLike) -> npt.NDArray[np.float64]:
    return checked_array(s, "arc lengths", "numbers in metres")


def _cells(line: str) -> list[str]:
    """The columns of a line without its comment."""
    bare = line.split("#", 1)[0].strip()
    mark = next((mark for mark in ",;\t" if mark in bare), None)
    return [cell.strip() for cell in bare.split(mark)] if bare else []


def _columns(rows: list[tuple[int, list[str]]], path: FilePath) -> tuple[tuple[int, int], list[tuple[int, list[str]]]]:
    """Which columns are x and z, and the rows below the header."""
    if not rows:
        raise FormatError(path, "holds no points: expected two columns, x and z in metres")
    number, first = rows[0]
    names = [name.lower().strip("\"'") for name in first]
    if not any(name[:1].isalpha() and name not in {"nan", "inf"} for name in names):
        return (0, 1), rows
    if "x" not in names or "z" not in names:
        raise FormatError(path, f"the header must name the columns x and z, found {', '.join(names)}", number)
    return (names.index("x"), names.index("z")), rows[1:]


def _number(row: list[str], column: int, path: FilePath, line: int) -> float:
    if column >= len(row):
        raise FormatError(path, f"expected two columns, x and z in metres, found {len(row)}", line)
    return to_float(row[column], path, line)
