"""The search against a textbook Dijkstra, the clearance against brute force, and hand-drawn maps."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import mask, scene, shortest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from motionrt.locomotion.scene import Agent, Scene
from motionrt.locomotion.scene.grid import Grid
from motionrt.locomotion.scene.penalty import Penalty
from motionrt.locomotion.scene.roadmap import build_roadmap
from motionrt.locomotion.scene.search import cheapest_route
from motionrt.locomotion.scene.tracing import clearance_along

GRIDS = arrays(
    np.bool_, st.tuples(st.integers(2, 14), st.integers(2, 14)), elements=st.sampled_from([True] * 3 + [False])
)


def flat(walkable: np.ndarray, cell: float = 1.0, radius: float = 0.0) -> Grid:
    return Grid(walkable, np.zeros(walkable.shape, np.float32), np.array([-3.0, 7.0]), cell, radius)


@settings(max_examples=60)
@given(GRIDS, st.randoms(use_true_random=False))
def test_routes_are_as_short_as_a_plain_dijkstra_finds_them(walkable: np.ndarray, random: object) -> None:
    cells = [tuple(cell) for cell in np.argwhere(walkable).tolist()]
    if len(cells) < 2:
        return
    start, goal = random.sample(cells, 2)  # type: ignore[attr-defined]
    roadmap = build_roadmap(flat(walkable), Penalty(0.0), 1)
    route = cheapest_route(roadmap, int(roadmap.node[start]), int(roadmap.node[goal]))
    expected = shortest(walkable, start, goal)
    if route is None:
        assert expected == np.inf
        return
    steps = np.linalg.norm(np.diff(roadmap.points[route], axis=0), axis=1)
    assert steps.max() <= np.sqrt(2) + 1e-6
    assert steps.sum() == pytest.approx(expected, abs=1e-6)


@settings(max_examples=50)
@given(GRIDS)
def test_clearance_is_the_distance_to_the_nearest_blocked_centre_less_half_a_cell(walkable: np.ndarray) -> None:
    padded = np.pad(walkable, 1)
    blocked = np.argwhere(~padded)
    expected = np.zeros(walkable.shape)
    for r, c in np.argwhere(walkable):
        expected[r, c] = np.linalg.norm(blocked - (r + 1, c + 1), axis=1).min() - 0.5
    np.testing.assert_allclose(flat(walkable, cell=0.2).clearance, expected * 0.2, atol=1e-5)


@settings(max_examples=50)
@given(GRIDS, arrays(np.float64, (6, 4), elements=st.floats(0.01, 0.99)))
def test_a_traced_way_meets_every_cell_that_dense_samples_meet(walkable: np.ndarray, ends: np.ndarray) -> None:
    grid = flat(walkable)
    size = np.array(grid.shape[::-1])
    start, end = grid.origin + ends[:, :2] * size, grid.origin + ends[:, 2:] * size
    clearance, metres = clearance_along(grid, start, end)
    np.testing.assert_allclose(metres.sum(axis=1), np.linalg.norm(end - start, axis=1), atol=1e-9)
    between = np.linspace(0, 1, 402)[1:-1, None]  # an end on a border belongs to the cell that the way is in
    samples = start[:, None] + between * (end - start)[:, None]
    assert (clearance.min(axis=1) <= grid.clearance_at(samples).min(axis=1) + 1e-6).all()


def test_a_way_through_the_touching_corners_of_two_walls_is_closed() -> None:
    grid = flat(mask(".# #."))
    assert clearance_along(grid, grid.centres([0], [0]), grid.centres([1], [1]))[0].min() == 0
    assert clearance_along(flat(mask(".. ..")), grid.centres([0], [0]), grid.centres([1], [1]))[0].min() > 0


def test_a_path_goes_round_a_wall() -> None:
    path = scene(
        """
        .........
        .........
        ####.####
        .........
        .........
        """
    ).plan((0.5, 0.5), (0.5, 4.5))
    assert path.length > 2 * 3
    assert path.project((4.5, 2.5))[1] < 0.7  # through the gap


def test_paths_keep_to_the_middle_of_a_corridor_where_the_shortest_would_touch_its_corner() -> None:
    world = np.ones((100, 100), dtype=bool)
    world[30:, 30:] = False  # an L of 3 m wide corridors at 0.1 m a cell
    near = Scene.from_cells(world, 0.1, agent=Agent(radius=0.25, comfort=0.25)).plan((1.5, 9.0), (9.0, 1.5))
    roomy = Scene.from_cells(world, 0.1, agent=Agent(radius=0.25, comfort=1.0)).plan((1.5, 9.0), (9.0, 1.5))
    corner = (3.0, 3.0)
    assert near.project(corner)[1] == pytest.approx(0.3, abs=0.15)
    assert roomy.project(corner)[1] > near.project(corner)[1] + 0.2
    assert near.length < roomy.length < near.length * 1.2


@settings(max_examples=25)
@given(GRIDS, st.integers(0, 1000), st.sampled_from([1, 2, 3]))
def test_every_place_of_a_path_is_free_on_random_maps(walkable: np.ndarray, seed: int, zoom: int) -> None:
    world = np.kron(walkable, np.ones((4 * zoom, 4 * zoom))).astype(bool)  # cells of 0.4 m with radius 0.15
    hall = Scene.from_cells(np.pad(world, 8, constant_values=True), 0.1 / zoom, agent=Agent(radius=0.15, comfort=0.4))
    free = np.argwhere(hall.grid.areas == hall.grid.areas[0 + 4, 0 + 4])
    picks = np.random.default_rng(seed).integers(len(free), size=2)
    start, goal = hall.grid.centres(*free[picks].T)
    if np.linalg.norm(start - goal) < 0.2:
        return
    path = hall.plan(start, goal)
    assert hall.free(path.at(np.linspace(0, path.length, 1000))[1:-1]).all()
    np.testing.assert_allclose(path.points[[0, -1]], [start, goal], atol=1e-5)


def test_corners_in_the_open_are_round_enough_to_walk() -> None:
    world = np.ones((120, 120), dtype=bool)
    world[50:70, :70] = False
    path = Scene.from_cells(world, 0.1).plan((1, 1), (1, 11))
    s = np.arange(0.3, path.length - 0.3, 0.05)
    before, after = path.tangent(s - 0.25), path.tangent(s + 0.25)
    turn = np.arccos(np.clip((before * after).sum(axis=1), -1, 1))
    assert turn.max() <= 0.5 / 0.4 + 0.15  # radians over half a metre of a 0.4 m circle, and a step of the polyline
    assert path.length > 15


def test_stops_on_the_way_are_passed_nearby() -> None:
    hall = Scene.from_cells(np.ones((100, 100), dtype=bool), 0.1)
    path = hall.plan((1, 1), (9, 1), via=[(5, 8)])
    assert path.project((5, 8))[1] < 1.0
    assert path.length > 13


def test_the_same_seed_draws_the_same_walk_and_its_length_is_the_one_asked_for() -> None:
    hall = Scene.from_cells(np.ones((100, 200), dtype=bool), 0.1)
    first, again, other = (hall.random_path(40, seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.points, again.points)
    assert not np.array_equal(first.points[0], other.points[0])
    assert first.length == pytest.approx(40, abs=1e-2)
    assert hall.free(first.at(np.arange(0, 40, 0.05))).all()
