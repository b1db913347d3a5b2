"""Ground drawn as polygons: walkable outlines with obstacles in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.grid import BoolArray, Points
from motionrt.untrusted.arguments import checked_array, real
from motionrt.untrusted.words import shown

Polygons = Sequence[npt.ArrayLike]


def draw_polygons(outlines: Polygons, obstacles: Polygons, cell: float) -> tuple[BoolArray, Points]:
    """Cells ``(H, W)`` whose centre lies in some outline and in no obstacle, and their origin (x, z).

    Args:
        outlines: polygons ``(N, 2)`` of (x, z) metres, either way round, closed by themselves.
        obstacles: polygons to cut out.
        cell: edge of a cell in metres.
    """
    if not outlines:
        raise SceneError("a scene from polygons needs at least one walkable outline")
    walkable = [_polygon(points, "outline", i) for i, points in enumerate(outlines)]
    blocked = [_polygon(points, "obstacle", i) for i, points in enumerate(obstacles)]
    low = np.min([polygon.min(axis=0) for polygon in walkable], axis=0)
    high = np.max([polygon.max(axis=0) for polygon in walkable], axis=0)
    columns, rows = grid_size(low, high, cell)
    xs, zs = low[0] + (np.arange(columns) + 0.5) * cell, low[1] + (np.arange(rows) + 0.5) * cell
    ground = np.any([_inside(polygon, xs, zs) for polygon in walkable], axis=0)
    for polygon in blocked:
        ground &= ~_inside(polygon, xs, zs)
    return ground, low


def grid_size(low: Points, high: Points, cell: float) -> tuple[int, int]:
    """Columns and rows of cells that cover ``low`` to ``high``."""
    if not 0 < real(cell) < np.inf:
        raise InvalidInputError(f"cell must be a positive number of metres, not {shown(cell)}")
    columns, rows = np.maximum(np.ceil((high - low) / cell - 1e-6), 1)
    if not columns * rows <= limits().cells:
        wide, deep = high - low
        raise SceneError(
            f"{wide:.0f} x {deep:.0f} m in cells of {cell:g} m is too large a grid: give a larger cell=, or scale=0.01 "
            f"if the file is in centimetres (0.001 for millimetres); {how_to_raise('cells')}"
        )
    return int(columns), int(rows)


def _polygon(points: npt.ArrayLike, kind: str, index: int) -> Points:
    polygon = checked_array(points, f"{kind} {index}", "at least three finite points (N, 2)")
    if polygon.ndim != 2 or polygon.shape[1] != 2 or len(polygon) < 3 or not np.isfinite(polygon).all():
        raise InvalidInputError(f"{kind} {index} must be at least three finite points (N, 2), not {polygon.shape}")
    if len(polygon) > limits().path_points:
        raise InvalidInputError(f"{kind} {index} has {len(polygon):,} corners: {how_to_raise('path_points')}")
    if not np.abs(polygon).max() <= limits().metres:
        raise InvalidInputError(f"{kind} {index} reaches too far from the origin: {how_to_raise('metres')}")
    return polygon


def _inside(polygon: Points, xs: Points, zs: Points) -> BoolArray:
    """Even-odd rule for all centres: every edge toggles what lies right of it in the rows that it crosses."""
    mask = np.zeros((len(zs), len(xs)), dtype=bool)
    for (xa, za), (xb, zb) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        rows = slice(*np.searchsorted(zs, sorted((za, zb))))
        crossing = xa + (zs[rows] - za) * ((xb - xa) / (zb - za if zb != za else 1.0))
        mask[rows] ^= xs > crossing[:, None]
    return mask
