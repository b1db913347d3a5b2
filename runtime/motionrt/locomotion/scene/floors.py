"""From patches of surface to one floor: where the agent stands, how high, and what it reaches from where it starts.

Every cell may have several floors above one another. Neighbouring floors are connected if the step between them is
low enough. Of what is connected to the start each cell keeps **one** floor, the first that is reached: of two storeys
that a staircase joins, the one nearer to the start. A scene of another storey is made with another start.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import SceneError
from motionrt.locomotion.scene.agent import Agent
from motionrt.locomotion.scene.grid import BoolArray, IntArray, Points
from motionrt.locomotion.scene.surface import LEVEL, Patches
from motionrt.motion.skeleton import FloatArray

_START_REACH = 0.5


@dataclass(frozen=True)
class Floors:
    """``N`` places to stand, sorted by cell and height: the cell, and lowest and highest point in metres, ``(N,)``."""

    cell: IntArray
    low: Points
    high: Points

    def __getitem__(self, which: npt.NDArray[np.generic]) -> Floors:
        return Floors(self.cell[which], self.low[which], self.high[which])


def standing_places(patches: Patches, cell: float, agent: Agent) -> Floors:
    """Flat patches, joined to floors, with head room and nothing to step onto above them.

    Raises:
        SceneError: there are none.
    """
    floors = _join(patches, gap=cell / 2 * np.tan(np.deg2rad(agent.max_slope)) + LEVEL)  # as samples lie on a slope
    if not len(floors.cell):
        message = f"no surface faces up at less than {agent.max_slope:g} degrees: if the file has Z up give up='z', if"
        raise SceneError(f"{message} its faces are wound the wrong way round double_sided=True")
    covered = np.append(floors.cell[1:] == floors.cell[:-1], False)
    rise = np.append(floors.high[1:] - floors.high[:-1], 0)
    floors = floors[~covered | (rise > agent.step_height)]
    floors = floors[~_blocked(floors, patches, agent)]
    if not len(floors.cell):
        raise SceneError(f"nowhere are {agent.head_room:g} m of head room above the ground: check scale=, or the agent")
    return floors


def _join(patches: Patches, gap: float) -> Floors:
    """Flat patches of one cell that follow each other within ``gap`` metres are one floor."""
    cell, low, high = patches.cell[patches.flat], patches.low[patches.flat], patches.high[patches.flat]
    starts = np.flatnonzero(np.append(True, (cell[1:] != cell[:-1]) | (low[1:] - high[:-1] > gap))[: len(cell)])
    if not len(starts):
        return Floors(cell, low, high)
    return Floors(cell[starts], low[starts], np.maximum.reduceat(high, starts))


def _blocked(floors: Floors, patches: Patches, agent: Agent) -> BoolArray:
    """Which floors have some surface between what a step clears and the head."""
    base = patches.low.min() - 1.0
    span = patches.high.max() - base + agent.head_room + 2.0
    tops = patches.cell * span + (patches.high - base)  # one number that sorts by cell, then height
    order = np.argsort(tops, kind="stable")
    mine = floors.cell * span + (floors.high - base)
    first = np.searchsorted(tops, mine + agent.step_height, side="right", sorter=order)
    index = order[np.minimum(first, len(tops) - 1)]
    above = (first < len(tops)) & (patches.cell[index] == floors.cell)
    return np.asarray(above & (patches.low[index] < floors.high + agent.head_room))


def reachable_floor(
    floors: Floors, shape: tuple[int, int], agent: Agent, start: int | None
) -> tuple[BoolArray, FloatArray]:
    """Walkable cells and their heights ``(H, W)`` of what is connected to a floor, the largest area if ``None``."""
    from scipy.sparse.csgraph import breadth_first_order

    graph = _steps(floors, shape, agent.step_height)
    first = _on_largest_area(graph, floors) if start is None else start
    order = breadth_first_order(graph, first, directed=False, return_predecessors=False)
    cells, earliest = np.unique(floors.cell[order], return_index=True)
    kept = order[earliest]
    height = np.full(shape, np.nan, dtype=np.float32)
    height.flat[cells] = (floors.low[kept] + floors.high[kept]) / 2
    return ~np.isnan(height) & ~_at_a_ledge(floors[kept], shape, agent.step_height), height


def _steps(floors: Floors, shape: tuple[int, int], step: float) -> object:
    """Sparse graph of the floors that a step leads between, from a cell to its neighbours right and below."""
    from scipy.sparse import coo_matrix

    heads, tails = [], []
    starts = np.searchsorted(floors.cell, np.arange(shape[0] * shape[1] + 1))
    most = int(np.diff(starts).max(initial=0))
    for offset, edge in (
        (1, floors.cell % shape[1] < shape[1] - 1),
        (shape[1], floors.cell < shape[1] * (shape[0] - 1)),
    ):
        mine = np.flatnonzero(edge)
        for layer in range(most):
            theirs = starts[floors.cell[mine] + offset] + layer
            mine, theirs = (side[theirs < starts[floors.cell[mine] + offset + 1]] for side in (mine, theirs))
            near = _rise(floors, mine, theirs) <= step
            heads.append(mine[near])
            tails.append(theirs[near])
    head, tail = np.concatenate(heads), np.concatenate(tails)
    return coo_matrix((np.ones(len(head), dtype=np.int8), (head, tail)), shape=(len(floors.cell),) * 2).tocsr()


def _rise(floors: Floors, a: IntArray, b: IntArray) -> Points:
    """Height of the step between floors: the gap between what they span."""
    return np.maximum(floors.low[a] - floors.high[b], floors.low[b] - floors.high[a])


def _on_largest_area(graph: object, floors: Floors) -> int:
    """The lowest of the floors in the connected area of most cells."""
    from scipy.sparse.csgraph import connected_components

    _, labels = connected_components(graph, directed=False)
    largest = np.flatnonzero(labels == np.bincount(labels).argmax())
    return int(largest[floors.low[largest].argmin()])


def _at_a_ledge(floors: Floors, shape: tuple[int, int], step: float) -> BoolArray:
    """Cells ``(H, W)`` beside another kept cell that is a step too high or too low."""
    low, high = (np.full(shape, np.nan) for _ in range(2))
    low.flat[floors.cell], high.flat[floors.cell] = floors.low, floors.high
    ledge = np.zeros(shape, dtype=bool)
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(0, shape[0] - down), slice(max(0, -right), shape[1] - max(0, right)))
        there = (slice(down, shape[0]), slice(max(0, right), shape[1] + min(0, right)))
        with np.errstate(invalid="ignore"):
            apart = np.maximum(low[here] - high[there], low[there] - high[here]) > step
        ledge[here] |= apart
        ledge[there] |= apart
    return ledge


def nearest_floor(floors: Floors, centres: Points, start: Points) -> int:
    """The floor nearest to ``start``, (x, z) or (x, y, z) metres; the lowest there if no height is given.

    Args:
        floors: places to stand.
        centres: ``(N, 2)`` the centres of their cells, (x, z) metres.
        start: ``(2,)`` or ``(3,)``.

    Raises:
        SceneError: it is more than half a metre away.
    """
    away = np.linalg.norm(centres - start[[0, -1]], axis=1)
    if len(start) == 3:
        away = np.hypot(away, floors.high - start[1])
    nearest = int(away.argmin())
    if away[nearest] > _START_REACH:
        raise SceneError(
            f"the start {tuple(map(float, start))} is {away[nearest]:.2f} m from the next ground to stand on"
        )
    return nearest
