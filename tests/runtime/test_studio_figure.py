"""The figure: a closed skin whose bones move it."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from motionrt.motion.skeleton import SMPL24, Skeleton
from motionrt.studio.figure import figure_of, skin_distance
from motionrt.studio.figure_cones import Cones, cones_of
from motionrt.studio.surface import surface_net


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (vertices[faces[:, i]].astype(float) for i in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def edges(faces: np.ndarray) -> np.ndarray:
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def test_the_net_of_a_sphere_is_the_sphere() -> None:
    corner = np.full(3, 0.6, dtype=np.float32)
    vertices, faces = surface_net(lambda p: np.linalg.norm(p, axis=1) - 0.5, -corner, corner, 0.05)
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 0.5, atol=1e-4)
    assert volume(vertices, faces) == pytest.approx(4 / 3 * np.pi * 0.5**3, rel=0.02)  # and faces look outwards


def test_the_skin_is_closed_and_as_large_as_a_person() -> None:
    figure = figure_of()
    there = Counter(map(tuple, edges(figure.faces).tolist()))
    assert there == Counter({(b, a): count for (a, b), count in there.items()})  # every edge has its opposite
    assert set(figure.faces.ravel().tolist()) == set(range(len(figure.vertices)))
    assert 0.05 < volume(figure.vertices, figure.faces) < 0.09  # cubic metres
    assert np.ptp(figure.vertices[:, 1]) == pytest.approx(1.75, abs=0.08)


def test_left_and_right_mirror_each_other() -> None:
    cones = cones_of(SMPL24)
    points = np.random.default_rng(0).uniform(-0.9, 0.9, (500, 3)).astype(np.float32)
    mirrored = points * np.array([-1, 1, 1], dtype=np.float32)
    np.testing.assert_allclose(skin_distance(cones, points), skin_distance(cones, mirrored), atol=2e-4)


def test_soles_are_at_the_height_of_the_balls_of_the_feet() -> None:
    figure = figure_of()
    sole = SMPL24.rest_positions[SMPL24.index("left_foot"), 1]
    assert figure.vertices[:, 1].min() == pytest.approx(sole, abs=0.02)


def test_weights_are_shares_of_few_bones_and_limbs_follow_their_own() -> None:
    figure = figure_of()
    np.testing.assert_allclose(figure.weights.sum(axis=1), 1, atol=1e-5)
    assert (figure.weights > 0).sum(axis=1).max() <= 4
    for side in (1, -1):  # what is beyond a wrist moves with that wrist
        beyond = side * figure.vertices[:, 0] > abs(SMPL24.rest_positions[SMPL24.index("left_wrist"), 0]) + 0.08
        wrist = SMPL24.index("left_wrist" if side > 0 else "right_wrist")
        assert beyond.any()
        assert (figure.weights[beyond, wrist] > 0.9).all()


def test_a_taller_skeleton_has_a_taller_figure() -> None:
    tall = Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets * np.float32(1.2))
    grown = np.ptp(figure_of(tall).vertices[:, 1]) / np.ptp(figure_of().vertices[:, 1])
    assert grown == pytest.approx(1.2, rel=0.02)


def test_the_distance_to_a_cone_is_that_to_a_sphere_where_it_is_one() -> None:
    centre = np.zeros((1, 3), dtype=np.float32)
    ball = Cones((0,), centre, centre, np.full((1, 2), 0.3, dtype=np.float32))
    points = np.random.default_rng(1).normal(size=(50, 3)).astype(np.float32)
    np.testing.assert_allclose(ball.distances(points)[:, 0], np.linalg.norm(points, axis=1) - 0.3, atol=1e-5)
    wide = replace(ball, ends=np.array([[1, 0, 0]], dtype=np.float32))
    assert wide.distances(np.array([[0.5, 1, 0]], dtype=np.float32))[0, 0] == pytest.approx(0.7, abs=1e-5)
