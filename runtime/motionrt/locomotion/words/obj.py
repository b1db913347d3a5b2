"""Semantic meshes as OBJ: every object, group or material is a label, and its faces become points."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted.files import read_utf8

STEP = 0.05  # metres between the points of a face
UNNAMED = "unlabelled"
_NAMES = ("o", "g", "usemtl")  # of these, the first kind that the file has tells the labels

Points = npt.NDArray[np.float64]


@dataclass
class _Mesh:
    vertices: list[tuple[float, float, float]] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    named: dict[str, list[str]] = field(default_factory=lambda: {kind: [] for kind in _NAMES})  # of each triangle


def read_obj(path: Path, step: float = STEP) -> tuple[Points, npt.NDArray[np.str_]]:
    """Points ``(N, 3)`` on the faces, about ``step`` metres apart, and their labels ``(N,)``.

    Labels are the names of objects (``o``), else of groups (``g``), else of materials (``usemtl``).

    Raises:
        FormatError: a line that is no OBJ, a corner that there is not, no faces, more points than the limit.
    """
    mesh = _parsed(path, read_utf8(path, lambda reason, line: FormatError(path, reason, line)))
    if not mesh.triangles:
        raise FormatError(path, "has no faces; a semantic OBJ has v, f and o, g or usemtl lines")
    kind = next((kind for kind in _NAMES if any(mesh.named[kind])), "o")
    labels = np.array([name or UNNAMED for name in mesh.named[kind]])
    corners = np.array(mesh.vertices)[np.array(mesh.triangles)]  # (T, 3, 3)
    sides = np.linalg.norm(corners[:, [1, 2]] - corners[:, :1], axis=-1).max(axis=1)
    parts = np.maximum(np.ceil(np.nan_to_num(sides / step, posinf=1e9)), 1).astype(np.int64)
    if int(((parts + 1) * (parts + 2) // 2).sum()) > limits().cloud_points:
        raise FormatError(path, f"has too large faces for points every {step:g} m: {how_to_raise('cloud_points')}")
    points = [_on(face, int(count)) for face, count in zip(corners, parts, strict=True)]
    return np.concatenate(points), np.repeat(labels, [len(part) for part in points])


def _parsed(path: Path, text: str) -> _Mesh:
    mesh, now = _Mesh(), dict.fromkeys(_NAMES, "")
    for line, row in enumerate(text.splitlines(), 1):
        word, _, rest = row.strip().partition(" ")
        if word in _NAMES:
            now[word] = rest.strip()
        elif word == "v":
            mesh.vertices.append(_vertex(path, line, rest))
        elif word == "f":
            corners = [_corner(path, line, corner, len(mesh.vertices)) for corner in rest.split()]
            if len(corners) < 3:
                raise FormatError(path, "a face needs three corners or more", line)
            for second, third in pairwise(corners[1:]):
                mesh.triangles.append((corners[0], second, third))
                for kind in _NAMES:
                    mesh.named[kind].append(now[kind])
    return mesh


def _vertex(path: Path, line: int, rest: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(value) for value in rest.split()[:3])
    except ValueError:
        raise FormatError(path, "a vertex needs three numbers", line) from None
    return x, y, z


def _corner(path: Path, line: int, corner: str, count: int) -> int:
    try:
        number = int(corner.split("/", maxsplit=1)[0])
    except ValueError:
        raise FormatError(path, f"'{corner[:40]}' is no corner of a face", line) from None
    index = number - 1 if number > 0 else count + number
    if not 0 <= index < count:
        raise FormatError(path, f"corner {number} is none of the {count} vertices so far", line)
    return index


def _on(face: Points, parts: int) -> Points:
    """Points on a triangle (3, 3), its sides cut in so many parts."""
    i, j = np.meshgrid(np.arange(parts + 1), np.arange(parts + 1))
    inside = i + j <= parts
    u, v = (i[inside] / parts)[:, None], (j[inside] / parts)[:, None]
    return np.asarray(face[0] + u * (face[1] - face[0]) + v * (face[2] - face[0]))
