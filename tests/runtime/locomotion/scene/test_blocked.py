"""No path: the error says why."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import scene

from motionrt.errors import InvalidInputError, PathError
from motionrt.locomotion.scene import Agent, Scene

ROOMS = np.ones((60, 101), dtype=bool)  # two rooms of 5 x 6 m at 0.1 m a cell
ROOMS[:, 50] = False


def rooms(door: int, radius: float = 0.25) -> Scene:
    world = ROOMS.copy()
    world[30 : 30 + door, 50] = True
    return Scene.from_cells(world, 0.1, agent=Agent(radius=radius))


def test_an_open_door_is_walked_through() -> None:
    path = rooms(door=9).plan((1, 1), (9, 1))
    assert path.project((5.05, 3.45))[1] < 0.2
    assert path.notes == ()


def test_a_door_that_is_too_narrow_is_measured_and_located() -> None:
    with pytest.raises(PathError, match=r"0\.30 m wide.*needs 0\.50 m") as caught:
        rooms(door=3).plan((1, 1), (9, 1))
    assert "near (5.05, 3.15)" in str(caught.value)
    rooms(door=3, radius=0.14).plan((1, 1), (9, 1))  # a slimmer one fits, as the message says


def test_a_closed_door_is_another_room() -> None:
    with pytest.raises(PathError, match=r"from the start \(1\.00, 1\.00\): it lies in another room"):
        rooms(door=0).plan((1, 1), (9, 1))


def test_ends_outside_the_scene() -> None:
    with pytest.raises(PathError, match=r"the start \(-4\.00, 1\.00\) is outside the scene"):
        rooms(door=9).plan((-4, 1), (9, 1))
    with pytest.raises(PathError, match="the goal"):
        rooms(door=9).plan((1, 1), (9, 99))


def test_an_end_deep_in_an_obstacle_names_the_next_free_ground() -> None:
    world = np.ones((60, 60), dtype=bool)
    world[20:40, 20:40] = False
    hall = Scene.from_cells(world, 0.1)
    with pytest.raises(PathError, match=r"the goal \(3\.00, 3\.00\) is in an obstacle.*next free ground is at"):
        hall.plan((1, 1), (3, 3))
    path = hall.plan((1, 1), (3, 3), snap=2.0)
    assert "moved" in path.notes[0]
    assert hall.free(path.points[-1])


def test_a_goal_beside_a_wall_is_walked_to_and_noted() -> None:
    hall = Scene.from_cells(np.ones((60, 60), dtype=bool), 0.1)
    path = hall.plan((3, 3), (0.1, 3))
    np.testing.assert_allclose(path.points[-1], [0.1, 3], atol=1e-6)
    assert "close to an obstacle" in path.notes[0]


def test_an_end_beside_a_thin_wall_stays_on_its_side() -> None:
    hall = rooms(door=9)
    path = hall.plan((4.95, 1.0), (1, 1))  # 5 cm from the wall: the nearest free cells are on both sides of it
    assert (path.points[:, 0] < 5).all()


def test_start_and_goal_at_one_place() -> None:
    with pytest.raises(PathError, match="same place"):
        rooms(door=9).plan((1, 1), (1, 1))


@pytest.mark.parametrize("bad", [(1, 2, 3), (np.nan, 1), "ab", 7])
def test_ends_that_are_no_places_are_refused(bad: object) -> None:
    with pytest.raises((InvalidInputError, ValueError)):
        rooms(door=9).plan(bad, (1, 1))  # type: ignore[arg-type]


def test_a_gap_of_one_cell_in_a_fine_map_is_found() -> None:
    world = np.ones((200, 200), dtype=bool)
    world[:, 99:102] = False
    world[77, 99:102] = True
    path = Scene.from_cells(world, 0.02, agent=Agent(radius=0.01, comfort=0.3)).plan((0.5, 0.5), (3.5, 0.5))
    assert path.project((2.0, 77.5 * 0.02))[1] < 0.02


def test_an_agent_too_wide_for_the_scene_is_told_so() -> None:
    with pytest.raises(PathError, match="nowhere in the scene is room for a radius of 3 m"):
        scene("... ... ...", radius=3).plan((0.5, 0.5), (2.5, 2.5))
