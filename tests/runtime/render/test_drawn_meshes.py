"""Triangles against pixel by pixel, and among rounded cones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from characters import character
from glb_files import glb
from motions import walking

from motionrt import render
from motionrt.rendering.meshes import Mesh, fragments, normals_of
from motionrt.rendering.solids import Solids, draw

SIDE = 40


def mesh_of(points: np.ndarray, faces: np.ndarray, colours: np.ndarray | None = None) -> Mesh:
    normals = np.tile(np.float32([0, 0, 1]), (len(points), 1))
    tints = np.full((len(faces), 3), 0.5, np.float32) if colours is None else colours
    return Mesh(points.astype(np.float32), normals, faces, tints)


def test_the_pixels_of_a_triangle_are_those_whose_middle_is_in_it() -> None:
    random = np.random.default_rng(0)
    points = random.uniform(-15, SIDE + 15, (90, 3))
    faces = np.arange(90).reshape(-1, 3)
    found: dict[tuple[int, int, int], float] = {}
    for x, y, z, face in fragments(mesh_of(points, faces), SIDE, SIDE):
        found.update(zip(zip(face.tolist(), x.tolist(), y.tolist(), strict=True), z.tolist(), strict=True))
    xs, ys = np.meshgrid(np.arange(SIDE), np.arange(SIDE))
    at = np.stack([xs.ravel() + 0.5, ys.ravel() + 0.5, np.ones(SIDE * SIDE)])
    missed = 0
    for face in range(len(faces)):
        corners = points[faces[face]]
        parts = np.linalg.solve(np.stack([corners[:, 0], corners[:, 1], np.ones(3)]), at)
        inside = (parts > 1e-6).all(axis=0)
        for index in np.flatnonzero(inside):
            key = (face, int(xs.ravel()[index]), int(ys.ravel()[index]))
            missed += key not in found
            if key in found:
                assert found.pop(key) == pytest.approx(float(parts[:, index] @ corners[:, 2]), abs=0.02)
    assert missed == 0
    assert len(found) < 5  # on an edge


def test_normals_of_a_cube_point_outwards() -> None:
    corners = np.float32([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])
    normals = normals_of(corners, faces)
    assert ((normals * (corners - 0.5)).sum(axis=1) > 0.3).all()
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(8), abs=1e-5)


@pytest.mark.parametrize("depth", [-20.0, 20.0])
def test_a_mesh_hides_what_is_behind_it_and_is_hidden_by_what_is_before(depth: float) -> None:
    ball = np.tile(np.float32([[[20, 20, 0]]]), (1, 2, 1))
    wall = mesh_of(np.array([[-99, -99, depth], [99, -99, depth], [0, 199, depth]]), np.array([[0, 1, 2]]),
                   np.float32([[0, 0, 1]]))  # fmt: skip
    red = Solids(ball, np.full((1, 2), 8, np.float32), np.float32([[1, 0, 0]]), (wall,))
    sprite = draw(red, SIDE, SIDE)
    assert sprite is not None
    middle, corner = sprite.rgb[20 - sprite.top, 20 - sprite.left], sprite.rgb[2 - sprite.top, 2 - sprite.left]
    assert (middle[2] > middle[0]) == (depth > 0)
    assert corner[2] > 2 * corner[0]


def test_a_mesh_beside_the_picture_is_left_out() -> None:
    nothing = Solids(*(np.zeros(shape, np.float32) for shape in ((0, 2, 3), (0, 2), (0, 3))))
    away = mesh_of(np.array([[90.0, 0, 0], [99, 0, 0], [95, 9, 0]]), np.array([[0, 1, 2]]))
    assert draw(Solids(nothing.ends, nothing.radii, nothing.colours, (away,)), SIDE, SIDE) is None


def test_a_character_is_drawn_in_its_colours_instead_of_the_figure(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image", reason="Pillow, of the extra render, is not installed")
    made = glb(character("mixamo"))
    made.document["materials"][0]["pbrMetallicRoughness"] = {"baseColorFactor": [0.0, 1.0, 0.0, 1.0]}
    points = made.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    places = np.frombuffer(bytes(made.binary), "<f4", 3 * made.document["accessors"][points]["count"]).reshape(-1, 3, 3)
    wide = places[:, :1] + (places - places[:, :1]) * 12  # triangles that can be seen
    made.binary[: wide.nbytes] = wide.astype("<f4").tobytes()
    hero = made.save(tmp_path / "hero.glb")
    for name in ("strip.png", "film.gif"):
        out = render(walking(12), tmp_path / name, character=hero, size=(300, 200), poses=3)
        pixels = np.asarray(image.open(out).convert("RGB")).astype(int)
        green = (pixels[..., 1] > pixels[..., 0] + 60) & (pixels[..., 1] > pixels[..., 2] + 60)
        blue = (pixels[..., 2] > pixels[..., 0] + 60) & (pixels[..., 2] > pixels[..., 1] + 20)
        assert green.sum() > 100
        assert blue.sum() == 0


def test_no_words_of_a_way_stand_on_a_head() -> None:
    pytest.importorskip("PIL", reason="Pillow, of the extra render, is not installed")
    from motionrt.rendering.places import _covers

    heads = np.array([[10.0, 10, 20, 30], [50, 50, 60, 60]])
    assert _covers((15, 0, 30, 12), heads)
    assert _covers((55, 55, 56, 56), heads)
    assert not _covers((21, 0, 49, 100), heads)
    assert not _covers((0, 0, 100, 9), heads)
