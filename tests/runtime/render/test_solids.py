"""Rounded cones against what they are: the hull of many spheres."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.rendering.solids import Solids, draw, surface

AXES = [(20, 5, 3), (0, 0, 0), (0.3, -0.2, 25), (0.3, -0.2, -25), (4, -3, 12), (-15, 15, -15), (3, 1, 2)]
RADII = [(6, 6), (3, 9), (9, 3), (8, 7.9)]


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("radii", RADII)
def test_a_rounded_cone_is_all_the_spheres_between_its_ends(
    axis: tuple[float, ...], radii: tuple[float, float]
) -> None:
    x, y = np.meshgrid(np.arange(-30, 40, 1.0), np.arange(-30, 40, 1.0))
    best = np.full(x.shape, -np.inf)
    for part in np.linspace(0, 1, 2001):
        radius = radii[0] + part * (radii[1] - radii[0])
        left = radius**2 - (x - part * axis[0]) ** 2 - (y - part * axis[1]) ** 2
        best = np.maximum(best, np.where(left >= 0, part * axis[2] + np.sqrt(np.maximum(left, 0)), -np.inf))
    z, nx, ny = surface(x.astype(np.float32), y.astype(np.float32), np.array(axis, np.float32), *map(float, radii))
    assert (np.isfinite(z) != np.isfinite(best)).sum() <= 2  # on the very edge
    seen = np.isfinite(z) & np.isfinite(best)
    assert np.abs(z[seen] - best[seen]).max() < 0.1
    assert (np.hypot(nx, ny)[seen] <= 1 + 1e-4).all()


def test_normals_of_a_sphere_point_away_from_its_centre() -> None:
    x, y = np.float32([[3.0, -6.0]]), np.float32([[4.0, 0.0]])
    z, nx, ny = surface(x, y, np.zeros(3, np.float32), 10.0, 10.0)
    np.testing.assert_allclose(np.stack([nx, ny, z / 10]), np.stack([x, y, np.sqrt(100 - x**2 - y**2)]) / 10, atol=1e-5)


def _ball(x: float, z: float, colour: tuple[float, float, float], radius: float = 8.0) -> Solids:
    ends = np.tile(np.array([[[x, 16.0, z]]], np.float32), (1, 2, 1))
    return Solids(ends, np.full((1, 2), radius, np.float32), np.array([colour], np.float32))


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_what_is_nearer_hides_what_is_behind_in_whatever_order_they_come(order: tuple[int, int]) -> None:
    balls = [_ball(16.0, 0.0, (1, 0, 0)), _ball(16.0, 30.0, (0, 0, 1), radius=4.0)]
    both = Solids(*(np.concatenate([getattr(balls[i], name) for i in order]) for name in ("ends", "radii", "colours")))
    sprite = draw(both, 32, 32)
    assert sprite is not None
    centre, edge = (sprite.rgb[16 - sprite.top, column - sprite.left] for column in (16, 10))
    assert centre[2] > 2 * centre[0]
    assert edge[0] > 2 * edge[2]


def test_solids_beyond_the_picture_are_cut_or_left_out() -> None:
    assert draw(_ball(-100.0, 0.0, (1, 1, 1)), 32, 32) is None
    sprite = draw(_ball(0.0, 0.0, (1, 1, 1)), 32, 32)
    assert sprite is not None
    assert sprite.left == 0
    assert sprite.mask[:, 0].max() == 255
