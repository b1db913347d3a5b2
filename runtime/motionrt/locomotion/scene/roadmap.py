"""The graph that a search runs on: one node per block of free cells, edges where the straight way between is free."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from motionrt.locomotion.scene.grid import BoolArray, Grid, IntArray, Points
from motionrt.locomotion.scene.penalty import Penalty
from motionrt.locomotion.scene.tracing import straight_open

_NEIGHBOURS = ((0, 1), (1, 0), (1, 1), (1, -1))  # half of the eight; edges lead both ways


@dataclass(frozen=True, eq=False)
class Roadmap:
    """``N`` nodes.

    Attributes:
        points: ``(N, 2)`` (x, z) metres, centres of free cells.
        edges: sparse ``(N, N)``, symmetric: what the way between two neighbouring nodes costs, in metres of easy way.
        node: ``(H', W')`` the node of every block of cells, -1 where it has none.
        factor: cells along the edge of a block.
    """

    points: Points
    edges: Any
    node: IntArray
    factor: int

    @cached_property
    def areas(self) -> IntArray:
        """``(N,)`` the number of the connected part that a node belongs to."""
        from scipy.sparse.csgraph import connected_components

        return np.asarray(connected_components(self.edges, directed=False)[1])


def build_roadmap(grid: Grid, penalty: Penalty, factor: int) -> Roadmap:
    """Nodes are the roomiest free cells of blocks of ``factor`` x ``factor`` cells.

    With a factor of 1 every free cell is a node, and no step cuts the corner of a blocked cell; otherwise an edge needs
    every cell that it crosses to be free.
    """
    rows, columns = _anchors(grid, penalty.comfort, factor)
    found = rows >= 0
    node = np.where(found, np.cumsum(found.ravel()).reshape(found.shape) - 1, -1)
    points = grid.centres(rows[found], columns[found])
    pairs = list(_pairs(node))
    if factor == 1:
        pairs[2:] = [_uncut(pair, node, right) for pair, right in zip(pairs[2:], (1, -1), strict=True)]
    head, tail = np.concatenate(pairs, axis=1)
    cost = _costs(grid, penalty, points[head], points[tail])
    open_way = np.ones(len(head), dtype=bool) if factor == 1 else _open(grid, points[head], points[tail])
    return Roadmap(points, _symmetric(head[open_way], tail[open_way], cost[open_way], len(points)), node, factor)


def _anchors(grid: Grid, comfort: float, factor: int) -> tuple[IntArray, IntArray]:
    """Row and column of the cell that stands for each block ``(H', W')``, -1 where none is free."""
    height, width = (-(-side // factor) for side in grid.shape)
    room = np.where(grid.free, np.minimum(grid.clearance, comfort) + 1, 0)
    room = np.pad(room, [(0, height * factor - grid.shape[0]), (0, width * factor - grid.shape[1])])
    blocks = room.reshape(height, factor, width, factor).swapaxes(1, 2).reshape(height, width, factor * factor)
    row, column = np.divmod(np.arange(factor * factor), factor)
    off_centre = np.hypot(row - (factor - 1) / 2, column - (factor - 1) / 2)
    best = np.where(blocks > 0, blocks - 0.1 * grid.cell * off_centre, -1).argmax(axis=-1)
    found = np.take_along_axis(blocks, best[..., None], axis=-1)[..., 0] > 0
    rows = np.arange(height)[:, None] * factor + row[best]
    columns = np.arange(width) * factor + column[best]
    return np.where(found, rows, -1), np.where(found, columns, -1)


def _pairs(node: IntArray) -> Iterator[IntArray]:
    """Nodes of neighbouring blocks, ``(2, E)`` for each of the four directions."""
    height, width = node.shape
    for down, right in _NEIGHBOURS:
        here = node[: height - down, max(0, -right) : width - max(0, right)]
        there = node[down:, max(0, right) : width + min(0, right)]
        both = (here >= 0) & (there >= 0)
        yield np.stack([here[both], there[both]])


def _uncut(pair: IntArray, node: IntArray, right: int) -> IntArray:
    """The diagonal steps whose two cells on either side are free as well."""
    height, width = node.shape
    rows, columns = np.divmod(np.flatnonzero(node.ravel() >= 0), width)
    row, column = rows[pair[0]], columns[pair[0]]
    beside = (node[row, np.clip(column + right, 0, width - 1)] >= 0) & (
        node[np.clip(row + 1, 0, height - 1), column] >= 0
    )
    return pair[:, beside]


def _costs(grid: Grid, penalty: Penalty, start: Points, end: Points) -> Points:
    """Cost ``(E,)`` of short straight ways: the mean of start, middle and end (Simpson's weights) by their length."""
    factors = [penalty.factor(grid.clearance_at(place)) for place in (start, (start + end) / 2, end)]
    return np.asarray((factors[0] + 4 * factors[1] + factors[2]) / 6 * np.linalg.norm(end - start, axis=1))


def _open(grid: Grid, start: Points, end: Points) -> BoolArray:
    """Whether straight ways are free. Most are because the whole rectangle around them is; the others are traced."""
    blocked = np.pad(np.cumsum(np.cumsum(~grid.free, axis=0, dtype=np.int64), axis=1), [(1, 0), (1, 0)])
    (r0, c0, _), (r1, c1, _) = grid.cells(np.minimum(start, end)), grid.cells(np.maximum(start, end))
    clear = blocked[r1 + 1, c1 + 1] - blocked[r0, c1 + 1] - blocked[r1 + 1, c0] + blocked[r0, c0] == 0
    doubtful = np.flatnonzero(~clear)
    clear[doubtful] = straight_open(grid, start[doubtful], end[doubtful])
    return np.asarray(clear)


def _symmetric(head: IntArray, tail: IntArray, cost: Points, count: int) -> Any:
    from scipy.sparse import coo_matrix

    both = np.concatenate([head, tail]), np.concatenate([tail, head])
    return coo_matrix((np.concatenate([cost, cost]), both), shape=(count, count)).tocsr()
