"""Shortcuts: a route on a grid turned into few straight legs that cost no more."""

from __future__ import annotations

import numpy as np

from motionrt.locomotion.scene.grid import Grid, Points
from motionrt.locomotion.scene.penalty import Penalty

_TOLERANCE = 1.005


def straightened(points: Points, grid: Grid, penalty: Penalty) -> Points:
    """The corners ``(M, 2)`` that are left of a route ``(N, 2)`` when free straight legs replace what costs more.

    Cost counts closeness to walls, so legs do not cling to corners that the route kept away from.
    """
    count = len(points) + 1
    while len(points) < count:
        count = len(points)
        points = _one_pass(points, grid, penalty)[::-1]  # alternately from both ends
        points = _one_pass(points, grid, penalty)[::-1]
    return points


def _one_pass(points: Points, grid: Grid, penalty: Penalty) -> Points:
    spent = np.append(0.0, np.cumsum(penalty.costs(grid, points[:-1], points[1:])))
    kept = [0]
    while kept[-1] < len(points) - 1:
        kept.append(_farthest(kept[-1], points, spent, grid, penalty))
    return points[kept]


def _farthest(i: int, points: Points, spent: Points, grid: Grid, penalty: Penalty) -> int:
    """The last point found that a straight leg from point ``i`` may lead to: doubled, then halved strides."""
    best, stride = i + 1, 2
    while i + stride < len(points) and _worthwhile(i, i + stride, points, spent, grid, penalty):
        best, stride = i + stride, stride * 2
    while stride > 1:
        stride //= 2
        if best + stride < len(points) and _worthwhile(i, best + stride, points, spent, grid, penalty):
            best += stride
    return best


def _worthwhile(i: int, j: int, points: Points, spent: Points, grid: Grid, penalty: Penalty) -> bool:
    cost = penalty.costs(grid, points[i : i + 1], points[j : j + 1])[0]
    return bool(cost <= (spent[j] - spent[i]) * _TOLERANCE + 1e-6)
