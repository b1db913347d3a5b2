"""Meshes: floors, stairs, tables, doors and storeys built from boxes."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest
from drawn import box, joined

from motionrt.errors import InvalidInputError, PathError, SceneError
from motionrt.locomotion.scene import Agent, Scene, surface

FLOOR = box((-4, -0.2, -4), (4, 0, 4))
SLIM = Agent(radius=0.2)


def stairs(rise: float, count: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Steps of 0.4 m along x from the floor up to a platform."""
    steps = [box((1 + 0.4 * i, 0, -1), (4.01, rise * (i + 1), 1)) for i in range(count)]
    return joined(FLOOR, *steps)


def test_a_floor_is_walkable_at_its_height() -> None:
    scene = Scene.from_mesh(FLOOR)
    np.testing.assert_allclose(scene.bounds, [[-4, -4], [4, 4]], atol=1e-6)
    assert scene.free([0, 0])
    assert not scene.free([3.9, 0])  # closer than the radius to the edge
    np.testing.assert_allclose(scene.height([[0, 0], [3.9, -3.9]]), 0, atol=1e-6)
    assert np.isnan(scene.height([5, 0]))


def test_stairs_are_climbed_if_the_steps_are_low_enough() -> None:
    scene = Scene.from_mesh(stairs(rise=0.2), agent=SLIM)
    path = scene.plan((-3, 0), (3.6, 0))
    np.testing.assert_allclose(scene.height(path.points[[0, -1]]), [0, 1.2], atol=1e-4)
    along = scene.height(path.at(np.arange(0, path.length, 0.05)))
    assert np.diff(along).max() <= 0.2 + 1e-5
    assert (np.diff(along) >= -1e-5).all()


def test_stairs_too_steep_for_the_agent_are_a_wall() -> None:
    world = stairs(rise=0.4)
    with pytest.raises(PathError, match=r"another room or on another floor|in an obstacle or off the ground"):
        Scene.from_mesh(world, agent=SLIM).plan((-3, 0), (3.6, 0))
    Scene.from_mesh(world, agent=Agent(radius=0.2, step_height=0.45)).plan((-3, 0), (3.6, 0))


def test_nobody_walks_off_the_side_of_stairs() -> None:
    scene = Scene.from_mesh(stairs(rise=0.2), agent=SLIM)
    path = scene.plan((3.6, 2.5), (3.6, 0))  # beside the platform, 1.2 m below it
    assert path.points[:, 0].min() < 1.3  # all the way round to the foot of the stairs
    assert path.length > 4


@pytest.mark.parametrize(("degrees", "open_way"), [(30, True), (39, True), (42, False), (60, False)])
def test_ramps_are_walkable_up_to_the_slope(degrees: float, open_way: bool) -> None:
    top = 2 * np.tan(np.deg2rad(degrees))
    ramp = np.array(
        [[0, 0, -2], [0, 0, 2], [2, top, 2], [2, top, -2], [4, top, 2], [4, top, -2], [-4, 0, 2], [-4, 0, -2]]
    )
    faces = [[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5], [7, 6, 1], [7, 1, 0]]
    scene = Scene.from_mesh((ramp, faces), start=(-3, 0))
    assert bool(scene.free([3, 0])) == open_way
    if open_way:
        np.testing.assert_allclose(scene.height([1, 0]), top / 2, atol=0.06)


def test_head_room_decides_what_is_passed_under() -> None:
    low, high = (joined(FLOOR, box((-1, bottom, -4), (1, bottom + 0.1, 4))) for bottom in (1.2, 2.0))
    assert not Scene.from_mesh(low, start=(-3, 0)).free([0, 0])
    assert Scene.from_mesh(high, start=(-3, 0)).free([0, 0])
    assert Scene.from_mesh(low, agent=Agent(head_room=1.0), start=(-3, 0)).free([0, 0])


def test_furniture_blocks_and_a_doorstep_is_stepped_on() -> None:
    table, doorstep = box((-2, 0, -2), (-1, 0.75, -1)), box((1, 0, 1), (3, 0.1, 3))
    scene = Scene.from_mesh(joined(FLOOR, table, doorstep), start=(0, 0))
    assert not scene.free([[-1.5, -1.5], [-0.9, -1.5]]).any()
    np.testing.assert_allclose(scene.height([[2, 2], [0, 0]]), [0.1, 0], atol=1e-6)
    assert scene.free([2, 2])


def test_a_wall_as_a_single_sheet_is_a_wall_and_its_door_a_door() -> None:
    def sheet(z0: float, z1: float, y0: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        corners = np.array([[0.033, y0, z0], [0.033, 3, z0], [0.033, 3, z1], [0.033, y0, z1]])
        return corners, np.array([[0, 1, 2], [0, 2, 3]])

    world = joined(FLOOR, sheet(-4, 1), sheet(2, 4), sheet(1, 2, y0=2.1))
    path = Scene.from_mesh(world).plan((-2, -2), (2, -2))
    crossing = path.points[np.argmin(np.abs(path.points[:, 0]))]
    assert 1.2 < crossing[1] < 1.8


def test_the_start_picks_the_storey() -> None:
    world = joined(FLOOR, box((-3, 3, -3), (3, 3.2, 3)))
    ground, upper, largest = (Scene.from_mesh(world, start=start) for start in ((0, 0, 0), (0, 3.2, 0), None))
    assert ground.height([0, 0]) == pytest.approx(0, abs=1e-6)
    assert upper.height([0, 0]) == pytest.approx(3.2)
    assert largest.height([0, 0]) == pytest.approx(0, abs=1e-6)
    assert not upper.free([3.5, 0])
    with pytest.raises(SceneError, match=r"m from the next ground"):
        Scene.from_mesh(world, start=(0, 1.6, 0))


def test_z_up_and_centimetres_are_turned_and_scaled() -> None:
    vertices, faces = stairs(rise=0.2)
    other = vertices[:, [0, 2, 1]] * (100, -100, 100)  # (x, y, z) -> (x, -z, y), in centimetres
    expected = Scene.from_mesh((vertices, faces), start=(-3, 0))
    scene = Scene.from_mesh((other, faces), up="z", scale=0.01, start=(-3, 0))
    np.testing.assert_array_equal(scene.grid.free, expected.grid.free)
    np.testing.assert_allclose(scene.grid.height, expected.grid.height, atol=1e-5)


def test_a_mesh_in_centimetres_read_as_metres_gets_a_hint() -> None:
    vertices, faces = FLOOR
    with pytest.raises(SceneError, match=r"scale=0\.01"):
        Scene.from_mesh((vertices * 100, faces))


def test_a_mesh_with_z_up_or_turned_inside_out_gets_a_hint() -> None:
    vertices, _ = FLOOR
    sheet = vertices[[1, 5, 7, 3]] * (1, 0, 1), np.array([[0, 1, 3], [1, 2, 3]])
    wall = sheet[0][:, [0, 2, 1]], sheet[1]
    with pytest.raises(SceneError, match="give up='z'"):
        Scene.from_mesh(wall)
    outside_in = (vertices[[2, 3, 7, 6]], np.array([[0, 3, 1], [1, 3, 2]]))
    with pytest.raises(SceneError, match="double_sided=True"):
        Scene.from_mesh(outside_in)
    assert Scene.from_mesh(outside_in, double_sided=True).free([0, 0])


@pytest.mark.parametrize("suffix", ["obj", "ply", "glb", "stl"])
def test_files_give_what_the_arrays_give(tmp_path: Path, suffix: str) -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh (extra 'scene') is not installed")
    world = stairs(rise=0.2)
    trimesh.Trimesh(*world, process=False).export(tmp_path / f"room.{suffix}")
    scene = Scene.open(tmp_path / f"room.{suffix}", start=(-3, 0))
    expected = Scene.from_mesh(world, start=(-3, 0))
    assert scene.grid.shape == expected.grid.shape
    assert (scene.grid.free != expected.grid.free).mean() < 0.005  # float32 files move edges across cell borders


def test_a_glb_keeps_its_parts_in_place(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh (extra 'scene') is not installed")
    parts = trimesh.Scene()
    parts.add_geometry(trimesh.Trimesh(*FLOOR, process=False))
    moved = trimesh.transformations.translation_matrix([2, 0, 2])
    parts.add_geometry(trimesh.Trimesh(*box((-0.5, 0, -0.5), (0.5, 1, 0.5)), process=False), transform=moved)
    parts.export(tmp_path / "parts.glb")
    scene = Scene.open(tmp_path / "parts.glb", start=(0, -3))
    assert scene.free([0, 0])
    assert not scene.free([2, 2])


def test_without_trimesh_the_error_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "room.obj").write_text("v 0 0 0\n", encoding="utf-8")

    def missing(name: str, package: str | None = None) -> object:
        raise ImportError(name)

    monkeypatch.setattr(importlib.import_module("motionrt.locomotion.scene.optional"), "import_module", missing)
    with pytest.raises(SceneError, match=r'pip install "motionrt\[scene\]"'):
        Scene.open(tmp_path / "room.obj")


def test_files_that_are_no_meshes_are_scene_errors(tmp_path: Path) -> None:
    pytest.importorskip("trimesh", reason="trimesh (extra 'scene') is not installed")
    (tmp_path / "bad.glb").write_bytes(b"not a mesh")
    (tmp_path / "empty.obj").write_text("v 0 0 0\n", encoding="utf-8")
    for name in ("bad.glb", "empty.obj"):
        with pytest.raises(SceneError, match=name):
            Scene.open(tmp_path / name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"up": "x"}, "up must be"),
        ({"scale": 0}, "scale must be"),
        ({"cell": -1}, "cell must be"),
        ({"start": (1,)}, "start must be"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        Scene.from_mesh(FLOOR, **options)  # type: ignore[arg-type]


def test_wrong_arrays_and_agents_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="faces name vertices"):
        Scene.from_mesh((np.zeros((3, 3)), [[0, 1, 3]]))
    with pytest.raises(InvalidInputError, match=r"need vertices \(V, 3\)"):
        Scene.from_mesh((np.zeros((3, 2)), [[0, 1, 2]]))
    with pytest.raises(InvalidInputError, match="radius must be"):
        Agent(radius=-1)
    with pytest.raises(InvalidInputError, match="head_room"):
        Agent(head_room=0.1)


def test_a_ground_of_two_triangles_may_be_a_hundred_metres_wide() -> None:
    corners = np.array([[0, 0, 0], [100, 0, 0], [100, 0, 100], [0, 0, 100]], float)
    scene = Scene.from_mesh((corners, np.array([[0, 2, 1], [0, 3, 2]])))
    assert scene.free([[50.0, 50.0], [99.0, 1.0]]).all()


def test_a_ground_that_would_take_seconds_is_refused_with_what_to_do() -> None:
    corners = np.array([[0, 0, 0], [400, 0, 0], [400, 0, 400], [0, 0, 400]], float)
    with pytest.raises(SceneError, match="larger cell="):
        Scene.from_mesh((corners, np.array([[0, 2, 1], [0, 3, 2]])))


def test_a_triangle_of_many_samples_is_sampled_in_bands_and_covered_as_in_one_piece(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    triangles = np.array([[[0, 0, 0], [0, 0, 90], [3, 0, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 1]]], np.float64)
    whole = list(surface._samples(triangles, 0.05))
    monkeypatch.setattr(surface, "_BATCH", 1000)
    bands = list(surface._samples(triangles, 0.05))
    assert len(whole) == 1
    assert len(bands) > 20
    assert max(len(points) for points, _ in bands) <= 2000
    for one in range(2):
        np.testing.assert_array_equal(np.concatenate([pair[one] for pair in bands]), whole[0][one])
