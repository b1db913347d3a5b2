"""``Grid``: the ground of a scene in square cells, and what an agent of some radius may use of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import checked_array

BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.int64]
Points = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Grid:
    """Row ``r`` and column ``c`` cover x from ``origin[0] + c * cell`` and z from ``origin[1] + r * cell``.

    Attributes:
        walkable: ``(H, W)`` whether a cell is ground without obstacles.
        height: ``(H, W)`` float32, metres, of the ground; NaN where there is none.
        origin: ``(2,)`` float64, the corner of lowest x and z, metres.
        cell: edge of a cell, metres.
        radius: of the agent, metres.
    """

    walkable: BoolArray
    height: FloatArray
    origin: Points
    cell: float
    radius: float

    def __post_init__(self) -> None:
        for name, dtype in (("walkable", np.bool_), ("height", np.float32), ("origin", np.float64)):
            array = np.array(getattr(self, name), dtype=dtype)
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows (z) and columns (x)."""
        return self.walkable.shape[0], self.walkable.shape[1]

    @property
    def least_clearance(self) -> float:
        """Metres of clearance from which a cell is free: the radius, less what rounding takes."""
        return max(self.radius - 1e-6, 1e-6)

    @cached_property
    def clearance(self) -> FloatArray:
        """``(H, W)`` metres from a cell's centre to the edge of the nearest cell that is not walkable; 0 in those."""
        from scipy.ndimage import distance_transform_edt

        cells = distance_transform_edt(np.pad(self.walkable, 1))[1:-1, 1:-1]
        return np.asarray(np.maximum((cells - 0.5) * self.cell, 0), dtype=np.float32)

    @cached_property
    def free(self) -> BoolArray:
        """``(H, W)`` whether the agent may stand with its centre here: no obstacle within its radius."""
        return np.asarray(self.clearance >= self.least_clearance)

    @cached_property
    def areas(self) -> npt.NDArray[np.int32]:
        """``(H, W)`` the number of the connected free area of a cell, from 1; 0 where it is not free.

        Steps lead to 8 neighbours and never between two blocked cells, so areas are those of 4 neighbours.
        """
        return label(self.free)

    def cells(self, xz: npt.ArrayLike) -> tuple[IntArray, IntArray, BoolArray]:
        """Row and column ``[...]`` of the cells of points ``[..., 2]``, clipped to the grid, and who lay inside."""
        place = np.floor((_places(xz) - self.origin) / self.cell)
        column, row = place[..., 0], place[..., 1]
        inside = (row >= 0) & (column >= 0) & (row < self.shape[0]) & (column < self.shape[1])
        rows, columns = (np.where(inside, axis, 0).astype(np.int64) for axis in (row, column))
        return rows, columns, inside

    def centres(self, rows: npt.ArrayLike, columns: npt.ArrayLike) -> Points:
        """Centres ``[..., 2]`` (x, z) of cells."""
        return self.origin + (np.stack([np.asarray(columns), np.asarray(rows)], axis=-1) + 0.5) * self.cell

    def is_free(self, xz: npt.ArrayLike) -> BoolArray:
        """Whether the agent may stand at points ``[..., 2]``."""
        rows, columns, inside = self.cells(xz)
        return np.asarray(self.free[rows, columns] & inside)

    def is_walkable(self, xz: npt.ArrayLike) -> BoolArray:
        """Whether points ``[..., 2]`` lie on ground without obstacles."""
        rows, columns, inside = self.cells(xz)
        return np.asarray(self.walkable[rows, columns] & inside)

    def clearance_at(self, xz: npt.ArrayLike) -> FloatArray:
        """Clearance in metres ``[...]`` of the cells of points ``[..., 2]``, 0 outside."""
        rows, columns, inside = self.cells(xz)
        return np.where(inside, self.clearance[rows, columns], 0).astype(np.float32)

    def height_at(self, xz: npt.ArrayLike) -> FloatArray:
        """Height in metres ``[...]`` of the ground under points ``[..., 2]``, between cells linearly; NaN off it."""
        points = _places(xz)
        place = (points - self.origin) / self.cell - 0.5
        low = np.floor(place)
        total, weights = np.zeros(points.shape[:-1]), np.zeros(points.shape[:-1])
        for corner in np.array([(0, 0), (0, 1), (1, 0), (1, 1)]):
            weight = np.abs(1 - corner - (place - low)).prod(axis=-1)
            rows, columns, inside = self.cells(self.origin + (low + corner + 0.5) * self.cell)
            weight = np.where(inside & self.walkable[rows, columns], weight, 0)
            total += weight * np.where(weight > 0, self.height[rows, columns], 0)
            weights += weight
        height = total / np.where(weights > 0, weights, 1)
        return np.where(self.is_walkable(points), height, np.nan).astype(np.float32)


def label(mask: BoolArray) -> npt.NDArray[np.int32]:
    """Number the 4-connected areas of a mask ``(H, W)`` from 1; 0 outside."""
    from scipy.ndimage import label as number

    return np.asarray(number(mask)[0], dtype=np.int32)


def _places(xz: npt.ArrayLike) -> Points:
    places = checked_array(xz, "places", "(x, z) in metres, one or more")
    if places.shape[-1:] != (2,):
        raise InvalidInputError(f"places must have the shape (..., 2), x and z in metres, not {places.shape}")
    return places
