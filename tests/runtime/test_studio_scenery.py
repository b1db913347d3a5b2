"""Scenes as they are drawn, and what clicks in them mean."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from motionrt.errors import InvalidInputError, SceneError, ScriptError
from motionrt.studio import picking, shapes
from motionrt.studio.scenery import floor_mesh, open_scenery, rectangles

ROOM = """
scene:
  floor: [[[0, 0], [4, 0], [4, 6], [0, 6]]]
  obstacles: [[[1, 2], [2, 2], [2, 3], [1, 3]]]
cloud: things.csv
start: {at: [0.5, 0.5], heading: 90}
steps: [{walk: {to: [3, 5]}}]
"""
THINGS = "x,y,z,label\n0,0,0,floor\n1.5,0.75,2.5,table\n1.6,0.75,2.5,table\n"


@pytest.fixture
def room(tmp_path: Path) -> Path:
    (tmp_path / "things.csv").write_text(THINGS, encoding="utf-8")
    file = tmp_path / "room.yaml"
    file.write_text(ROOM, encoding="utf-8")
    return file


def area(mesh: shapes.Mesh) -> float:
    a, b, c = (mesh[0][mesh[1][:, i]].astype(float) for i in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


@given(arrays(bool, st.tuples(st.integers(1, 9), st.integers(1, 9))), st.integers(0, 3))
def test_rectangles_cover_every_cell_once_and_nothing_else(cells: np.ndarray, kinds: int) -> None:
    kind = (np.arange(cells.size).reshape(cells.shape) % (kinds + 1) == 0).astype(np.float32)
    covered = np.zeros(cells.shape, dtype=int)
    for top, left, bottom, right in rectangles(cells, kind):
        covered[top:bottom, left:right] += 1
        assert len(np.unique(kind[top:bottom, left:right])) == 1
    np.testing.assert_array_equal(covered, cells)


def test_flat_ground_is_few_rectangles_that_face_up() -> None:
    mesh = floor_mesh(np.ones((50, 80), bool), np.zeros((50, 80), np.float32), np.array([1.0, 2.0]), 0.1)
    assert len(mesh[1]) == 2
    assert area(mesh) == pytest.approx(5.0 * 8.0, rel=1e-5)
    a, b, c = mesh[0][mesh[1][0]]
    assert np.cross(b - a, c - a)[1] > 0
    np.testing.assert_allclose(mesh[0].min(axis=0), [1, 0, 2])


def test_a_script_brings_its_scene_its_things_and_its_steps(room: Path) -> None:
    scenery, script = open_scenery(room)
    assert scenery is not None
    assert script is not None
    assert area(scenery.floor) == pytest.approx(4 * 6 - 1, rel=0.05)
    assert len(scenery.things) == 2
    assert "floor plan" in scenery.name
    assert script.start.heading == pytest.approx(np.pi / 2)


def test_a_click_meets_a_thing_before_the_ground_behind_it(room: Path) -> None:
    scenery, _ = open_scenery(room)
    assert scenery is not None
    eye = np.array([1.5, 3.0, 0.0])
    np.testing.assert_allclose(scenery.hit(eye, np.array([1.5, 0.75, 2.5]) - eye), [1.5, 0.75, 2.5], atol=1e-6)
    np.testing.assert_allclose(scenery.hit(eye, np.array([3.5, 0.0, 5.0]) - eye), [3.5, 0.0, 5.0], atol=1e-5)
    assert scenery.hit(eye, [0, 1, 0]) is None


def test_meshes_are_drawn_and_hit_themselves(tmp_path: Path) -> None:
    pytest.importorskip("trimesh", reason="reading meshes needs trimesh, which is not installed")
    file = tmp_path / "step.obj"
    corners = "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 1 0.2 1\nv 3 0.2 1\nv 3 0.2 3\nv 1 0.2 3\n"
    file.write_text(corners + "f 1 4 3\nf 1 3 2\nf 5 8 7\nf 5 7 6\n", encoding="utf-8")
    scenery, script = open_scenery(file)
    assert script is None
    assert scenery is not None
    assert scenery.triangles is not None
    np.testing.assert_allclose(scenery.hit([2, 5, 2], [0, -1, 0]), [2, 0.2, 2], atol=1e-6)
    assert not len(scenery.obstacles[0])


@pytest.mark.parametrize(
    ("name", "content", "error"),
    [("no.obj", None, InvalidInputError), ("bad.yaml", "steps: [", ScriptError), ("odd.xyz", "?", InvalidInputError)],
)
def test_what_cannot_be_read_is_a_typed_error(
    tmp_path: Path, name: str, content: str | None, error: type[Exception]
) -> None:
    if content is not None:
        (tmp_path / name).write_text(content, encoding="utf-8")
    with pytest.raises((error, SceneError)):
        open_scenery(tmp_path / name)


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.5, 5))
def test_a_ray_meets_a_triangle_where_it_was_aimed(x: float, z: float, height: float) -> None:
    triangle = np.array([[[-6, 0, -6], [-6, 0, 20], [20, 0, -6]]], dtype=np.float32)
    aim, eye = np.array([x, 0.0, z]), np.array([1.0, height, 2.0])
    np.testing.assert_allclose(picking.triangle_hit(eye, aim - eye, triangle), aim, atol=1e-3)
    np.testing.assert_allclose(picking.ground_hit(eye, aim - eye), aim, atol=1e-3)
    assert picking.triangle_hit(eye, eye - aim, triangle) is None


def test_bands_and_discs_face_up_and_have_their_size() -> None:
    line = np.array([[0, 0], [3, 0], [3, 4]], dtype=np.float32)
    for mesh in (shapes.ribbon(line, 0.1), shapes.disc(0.5), shapes.arrow()):
        a, b, c = (mesh[0][mesh[1][:, i]] for i in range(3))
        assert (np.cross(b - a, c - a)[:, 1] >= -1e-9).all()
    assert area(shapes.disc(0.5, 200)) == pytest.approx(np.pi * 0.25, rel=1e-3)
    assert area(shapes.ribbon(line[:2], 0.1)) == pytest.approx(0.3, rel=1e-5)
    assert not len(shapes.ribbon(line[:1], 0.1)[1])


def test_boxes_have_six_sides_outwards() -> None:
    vertices, faces = shapes.boxes(np.array([[0, 0, 0]], np.float32), np.array([[1, 2, 3]], np.float32))
    a, b, c = (vertices[faces[:, i]].astype(float) for i in range(3))
    assert (a * np.cross(b, c)).sum() / 6 == pytest.approx(6.0)
    assert area((vertices, faces)) == pytest.approx(22.0)
