"""Write the points of the living room that ``living_room.yaml`` plays in: boxes, each with a name.

The one argument is the file to write: ``python examples/make_living_room.py examples/living_room.csv``.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt

Box = tuple[tuple[float, float], tuple[float, float], tuple[float, float]]  # from and to: x, y (up), z in metres

SPACING = 0.1  # metres between points of a surface
FLOOR_SPACING = 0.5
ROOM: tuple[Box, ...] = (((-1.0, 7.0), (0.0, 0.0), (-3.0, 9.5)), ((7.0, 9.8), (0.0, 0.0), (-2.0, -0.4)))
FURNITURE: tuple[tuple[str, Box], ...] = (
    ("sofa", ((2.6, 4.6), (0.42, 0.42), (8.5, 9.2))),  # the seat
    ("sofa", ((2.6, 4.6), (0.42, 0.82), (9.2, 9.4))),  # the back
    ("sofa", ((2.6, 4.6), (0.1, 0.42), (8.5, 8.5))),  # below the edge
    *(("shelf", ((6.6, 7.0), (level, level), (3.0, 4.6))) for level in (0.3, 0.6, 0.9, 1.2, 1.5)),
    ("shelf", ((6.6, 7.0), (0.0, 1.5), (3.0, 3.0))),
    ("shelf", ((6.6, 7.0), (0.0, 1.5), (4.6, 4.6))),
    ("table", ((1.2, 3.0), (0.75, 0.75), (2.6, 4.2))),
    ("plant", ((-0.4, 0.0), (0.0, 1.2), (7.2, 7.6))),
)


def main() -> None:
    rows = [(*point, "floor") for box in ROOM for point in surface(box, FLOOR_SPACING)]
    rows += [(*point, name) for name, box in FURNITURE for point in surface(box, SPACING)]
    with Path(sys.argv[1]).open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("x", "y", "z", "label"), *rows])


def surface(box: Box, spacing: float) -> list[list[float]]:
    """Points on the faces of a box, which may be flat: (N, 3)."""
    axes = [_steps(low, high, spacing) for low, high in box]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    low, high = np.array(box).T
    flat = low == high
    edge = ((np.isclose(grid, low) | np.isclose(grid, high)) & ~flat).any(axis=1) | flat.any()
    return [[round(float(value), 3) for value in point] for point in grid[edge]]


def _steps(low: float, high: float, spacing: float) -> npt.NDArray[np.float64]:
    return np.linspace(low, high, 1 + round((high - low) / spacing))


if __name__ == "__main__":
    main()
