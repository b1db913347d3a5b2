"""The cells that straight ways cross, exactly: every one of them, however little of it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.scene.grid import BoolArray, Grid, Points

_TOUCH = 1e-7  # cells: a way through a cell that is shorter only touches its corner


def clearance_along(grid: Grid, start: Points, end: Points) -> tuple[Points, Points]:
    """Clearance in the cells that straight ways cross and the metres in each: ends ``(E, 2)`` -> two ``(E, K)``.

    Where a way passes exactly between two cells that touch with their corners, the lesser clearance of the two counts.
    Shorter rows are filled up with infinite clearance over 0 m.
    """
    middle, share = _pieces((start - grid.origin) / grid.cell, (end - grid.origin) / grid.cell)
    length = np.linalg.norm(end - start, axis=1)[:, None]
    clearance = _looked_up(grid, middle)
    touch = share * length / grid.cell < _TOUCH
    touch[touch.all(axis=1), 0] = False  # no way at all, but still a place
    clearance[touch] = np.inf
    _mind_corners(grid, middle, touch, end - start, clearance)
    return clearance, share * length


def straight_open(grid: Grid, start: Points, end: Points, least: float | None = None) -> BoolArray:
    """Whether straight ways between ``(E, 2)`` and ``(E, 2)`` keep ``least`` metres of clearance (the radius)."""
    clearance, _ = clearance_along(grid, start, end)
    return np.asarray((clearance >= (grid.least_clearance if least is None else least)).all(axis=1))


def _pieces(start: Points, end: Points) -> tuple[Points, Points]:
    """Middles ``(E, K, 2)`` of the pieces that grid lines cut ways into, in cells, and their shares of the way."""
    step = end - start
    ends = np.zeros((len(start), 1)), np.ones((len(start), 1))
    t = np.concatenate([ends[0], _crossings(start, step, 0), _crossings(start, step, 1), ends[1]], axis=1)
    t.sort(axis=1)
    return start[:, None] + ((t[:, 1:] + t[:, :-1]) / 2)[..., None] * step[:, None], np.diff(t, axis=1)


def _crossings(start: Points, step: Points, axis: int) -> Points:
    """Where on the way ``(E, n)``, from 0 to 1, it crosses the grid lines of one axis; filled up with 1."""
    low = np.minimum(start[:, axis], start[:, axis] + step[:, axis])
    first = np.floor(low) + 1
    count = int(np.ceil(np.abs(step[:, axis]).max(initial=0)))
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (first[:, None] + np.arange(count) - start[:, axis, None]) / step[:, axis, None]
    return np.where((t > 0) & (t < 1), t, 1.0)


def _looked_up(grid: Grid, middle: Points) -> Points:
    column, row = (np.clip(middle[..., axis].astype(np.int64), 0, grid.shape[1 - axis] - 1) for axis in (0, 1))
    return grid.clearance[row, column].astype(np.float64)


def _mind_corners(grid: Grid, middle: Points, touch: npt.NDArray[np.bool_], step: Points, clearance: Points) -> None:
    """Lower ``clearance`` where a way only touches a corner to that of the cells on its two sides."""
    edge, piece = np.nonzero(touch)
    aside = step[edge][:, ::-1] * (-1, 1) / np.maximum(np.linalg.norm(step[edge], axis=1, keepdims=True), 1e-12) * 1e-4
    place = middle[edge, piece]
    inner = np.abs(place - np.round(place)).max(axis=1, initial=0) < 1e-5  # a corner, and no end or fill-up elsewhere
    edge, piece, place, aside = (array[inner] for array in (edge, piece, place, aside))
    clearance[edge, piece] = np.minimum(_looked_up(grid, place + aside), _looked_up(grid, place - aside))
