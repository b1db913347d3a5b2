"""Scenes drawn as polygons."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.errors import InvalidInputError, SceneError
from motionrt.locomotion.scene import Agent, Scene

SQUARE = [(0, 0), (6, 0), (6, 6), (0, 6)]


def test_areas_and_holes_are_those_of_the_polygons() -> None:
    triangle = [(0, 0), (8, 0), (0, 6)]
    disc = np.stack([3 + np.cos(np.linspace(0, 2 * np.pi, 60)), 3 + np.sin(np.linspace(0, 2 * np.pi, 60))], axis=1)
    assert Scene.from_polygons([triangle]).grid.walkable.sum() * 0.05**2 == pytest.approx(24, rel=0.01)
    assert Scene.from_polygons([SQUARE], [disc]).grid.walkable.sum() * 0.05**2 == pytest.approx(36 - np.pi, rel=0.01)
    assert Scene.from_polygons([SQUARE[::-1]]).grid.walkable.all()


def test_outlines_join_and_a_path_leads_round_an_obstacle() -> None:
    annex = [(5, 2), (12, 2), (12, 4), (5, 4)]
    scene = Scene.from_polygons([SQUARE, annex], [[(2, 1), (4, 1), (4, 6), (2, 6)]], agent=Agent(radius=0.2))
    path = scene.plan((1, 5), (11, 3))
    assert path.project((3, 0.5))[1] < 0.4
    assert scene.free(path.at(np.arange(0, path.length, 0.02))).all()
    assert repr(scene).startswith("Scene(")


def test_polygons_that_are_none_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="outline 1"):
        Scene.from_polygons([SQUARE, [(0, 0), (1, 1)]])
    with pytest.raises(InvalidInputError, match="obstacle 0"):
        Scene.from_polygons([SQUARE], [[(0, 0), (1, 1), (np.nan, 2)]])
    with pytest.raises(SceneError, match="at least one"):
        Scene.from_polygons([])
    with pytest.raises(SceneError, match="too large a grid"):
        Scene.from_polygons([np.array(SQUARE) * 1000])
