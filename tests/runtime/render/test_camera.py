"""Cameras against perspective worked by hand."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.errors import InvalidInputError
from motionrt.rendering.camera import CAMERAS, checked_camera, fitted, looking

ORIGIN = np.zeros(3, np.float32)


def _seen(camera: str | float, point: tuple[float, float, float], heading: float = 0.0) -> np.ndarray:
    view = looking(camera, heading, 0.0, ORIGIN, 1000.0)
    return np.round(view.project(np.array(point, np.float32))[0], 2)


@pytest.mark.parametrize(
    ("camera", "right"),
    [("front", (1, 0, 0)), ("back", (-1, 0, 0)), ("side", (0, 0, 1)), ("left", (0, 0, -1)), (90, (0, 0, 1))],
)
def test_named_cameras_have_the_right_thing_on_the_right(camera: str | float, right: tuple[int, int, int]) -> None:
    """Somebody who faces +Z has the left hand at +X: to the right of who looks at the face."""
    np.testing.assert_allclose(_seen(camera, right)[:2], [1, 0], atol=0.01)


def test_cameras_go_with_the_heading_of_the_character() -> None:
    np.testing.assert_allclose(_seen("side", (1, 0, 0), heading=np.pi / 2)[:2], [1, 0], atol=0.01)


def test_up_is_up_and_nearer_is_larger() -> None:
    view = looking("front", 0.0, 0.0, ORIGIN, 4.0)
    (x, y, near), size = view.project(np.array([0.5, 1.0, 2.0], np.float32))
    assert (x, y) == pytest.approx((1.0, -2.0))  # half as far away, twice as large
    assert size == pytest.approx(2.0)
    assert near > view.project(ORIGIN)[0][2]


def test_depth_grows_as_fast_as_size_so_that_spheres_stay_round() -> None:
    view = looking("front", 0.0, 0.0, ORIGIN, 5.0)
    points = np.array([[0, 0, 1.0], [0, 0, 1.001]], np.float32)
    pixels, size = view.project(points)
    assert (pixels[1, 2] - pixels[0, 2]) / 0.001 == pytest.approx(size[0], rel=0.01)


def test_a_fitted_camera_fills_the_box_one_way_and_centres_the_other() -> None:
    points = np.array([[-1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]], np.float32)
    view = fitted(looking("front", 0.0, 0.0, ORIGIN, 6.0), points, (10, 20, 110, 220))
    pixels = view.project(points)[0]
    assert pixels[:, 0].min() == pytest.approx(10, abs=0.01)
    assert pixels[:, 0].max() == pytest.approx(110, abs=0.01)
    assert (pixels[:, 1].min() + pixels[:, 1].max()) / 2 == pytest.approx(120, abs=0.01)


@pytest.mark.parametrize("camera", ["up", "nan", "", None, float("inf")])
def test_an_unknown_camera_is_an_error_that_lists_those_there_are(camera: object) -> None:
    with pytest.raises(InvalidInputError, match="three-quarter"):
        checked_camera(camera)  # type: ignore[arg-type]


def test_degrees_may_be_text() -> None:
    assert checked_camera("-35.5") == -35.5
    assert all(checked_camera(name) == name for name in CAMERAS)
