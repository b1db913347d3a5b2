"""The surface of a mesh over the cells of a grid: which heights it passes at, and where one could stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from motionrt.errors import InvalidInputError, SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.grid import BoolArray, IntArray, Points
from motionrt.locomotion.scene.mesh import Triangles
from motionrt.locomotion.scene.polygons import grid_size
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown

_BATCH = 2_000_000  # samples in memory at once
LEVEL = 0.02  # metres: samples of one cell in one level of this height are one patch

Part = tuple[IntArray, Points, Points, BoolArray]


@dataclass(frozen=True)
class Patches:
    """Pieces of surface, sorted by cell and height; ``P`` of them.

    Attributes:
        cell: ``(P,)`` row * columns + column.
        low: ``(P,)`` metres, of the lowest point of the piece.
        high: ``(P,)`` metres, of its highest point.
        flat: ``(P,)`` whether a foot can stand on it.
        shape: rows and columns of the grid.
        origin: ``(2,)`` (x, z) of its low corner, metres.
    """

    cell: IntArray
    low: Points
    high: Points
    flat: BoolArray
    shape: tuple[int, int]
    origin: Points

    def centres(self, cells: IntArray, edge: float) -> Points:
        """Centres ``(N, 2)`` (x, z) of cells of this grid, whose edge is given in metres."""
        rows, columns = np.divmod(cells, self.shape[1])
        return np.asarray(self.origin + (np.stack([columns, rows], axis=-1) + 0.5) * edge)


def sample_surface(triangles: Triangles, cell: float, max_slope: float, *, double_sided: bool = False) -> Patches:
    """Sample triangles ``(T, 3, 3)`` at half a cell's distance and gather the samples in cells and levels.

    A triangle is flat if it faces up and is at most ``max_slope`` degrees steep; ``double_sided`` takes those that face
    down for flat too, which helps meshes with faces the wrong way round.
    """
    if not 0 < real(cell) < np.inf:
        raise InvalidInputError(f"cell must be a positive number of metres, not {shown(cell)}")
    low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
    columns, rows = grid_size(low[[0, 2]], high[[0, 2]], cell)
    flat = _upward(triangles, double_sided=double_sided) >= np.cos(np.deg2rad(max_slope)) - 1e-6
    parts = []
    for points, owner in _samples(triangles, cell / 2):
        place = np.floor((points[:, [0, 2]] - low[[0, 2]]) / cell).astype(np.int64)
        index = np.clip(place[:, 1], 0, rows - 1) * columns + np.clip(place[:, 0], 0, columns - 1)
        parts.append(_gather((index, points[:, 1], points[:, 1], flat[owner])))
    cells, bottoms, tops, stands = zip(*parts, strict=True)
    joined = (np.concatenate(cells), np.concatenate(bottoms), np.concatenate(tops), np.concatenate(stands))
    return Patches(*_gather(joined), (rows, columns), low[[0, 2]])


def _upward(triangles: Triangles, *, double_sided: bool) -> Points:
    """The vertical part of unit normals ``(T,)``; 0 for triangles without area."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normals, axis=1)
    up = normals[:, 1] / np.where(length > 1e-12, length, 1)
    return np.abs(up) if double_sided else up


def _samples(triangles: Triangles, spacing: float) -> Iterator[tuple[Points, IntArray]]:
    """Points ``(N, 3)`` that cover the triangles, edges included, and the triangle of each, in batches.

    Every triangle is cut into rows from its shortest edge to the opposite corner.
    """
    edges = np.linalg.norm(triangles - np.roll(triangles, -1, axis=1), axis=2)  # edge k joins corners k and k + 1
    first = edges.argmin(axis=1)
    turned = np.take_along_axis(triangles, ((first[:, None] + np.arange(3)) % 3)[..., None], axis=1)
    rows = np.ceil(edges.max(axis=1) / spacing).astype(np.int64) + 1
    across = np.ceil(edges.min(axis=1) / spacing).astype(np.int64) + 1
    stretched = max(limits().stretched_samples, 500 * len(triangles))
    if (rows * (across + 1.0)).sum() / 2 > min(stretched, limits().samples):
        raise SceneError(
            f"the mesh is too large for cells of {2 * spacing:g} m: give a larger cell=, check scale=, or: "
            f"{how_to_raise('stretched_samples' if stretched < limits().samples else 'samples')}"
        )
    names, starts, counts = _bands(rows, across)
    total = np.cumsum(counts * across[names])
    for part in np.split(np.arange(len(names)), np.searchsorted(total, np.arange(_BATCH, total[-1], _BATCH))):
        if len(part):
            some = names[part]
            yield _fill(turned[some], rows[some], across[some], some, starts[part], counts[part])


def _bands(rows: IntArray, across: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Triangles in bands of rows that are no batch each: ``(B,)`` the triangle, its first row, and how many rows."""
    most = np.maximum(_BATCH // across, 1)
    name, band = _count_up(-(-rows // most))
    starts = band * most[name]
    return name, starts, np.minimum(most[name], rows[name] - starts)


def _fill(
    triangles: Triangles, rows: IntArray, across: IntArray, names: IntArray, starts: IntArray, counts: IntArray
) -> tuple[Points, IntArray]:
    """Samples of bands of triangles of ``rows`` rows each, the first as long as the first edge, the last a point."""
    owner, row = _count_up(counts)
    down = (row + starts[owner]) / np.maximum(rows[owner] - 1, 1)
    width = np.ceil((across[owner] - 1) * (1 - down)).astype(np.int64) + 1
    a, b, c = (triangles[owner, k] for k in range(3))
    begin, stride = a + down[:, None] * (c - a), (b - a) * ((1 - down) / np.maximum(width - 1, 1))[:, None]
    row_of, step = _count_up(width)
    return begin[row_of] + step[:, None] * stride[row_of], names[owner[row_of]]


def _count_up(counts: IntArray) -> tuple[IntArray, IntArray]:
    """``[2, 3]`` -> owners ``[0, 0, 1, 1, 1]`` and numbers ``[0, 1, 0, 1, 2]``."""
    owner = np.repeat(np.arange(len(counts)), counts)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)


def _gather(part: Part) -> Part:
    """Join what shares cell, level and kind; sorted by cell, then height."""
    cell, low, high, flat = part
    level = np.floor((low - low.min()) / LEVEL + 0.5).astype(np.int64)
    key = (cell * (level.max() + 1) + level) * 2 + flat
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    bottom, top = np.minimum.reduceat(low[order], starts), np.maximum.reduceat(high[order], starts)
    return cell[order][starts], bottom, top, flat[order][starts]
