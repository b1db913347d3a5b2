"""Limbs inside surfaces: found, measured to the depth that geometry says, and not where they only touch."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import standing

from motionrt.errors import InvalidInputError
from motionrt.metrics import penetration, penetration_depths
from motionrt.metrics.penetration import THICKNESS
from motionrt.motion import SMPL24


def wall(x: float, step: float = 0.08) -> np.ndarray:
    """Points on the plane x = const."""
    grid = np.stack(np.meshgrid([x], np.arange(-0.5, 2.5, step), np.arange(-1.5, 1.5, step)), axis=-1)
    return grid.reshape(-1, 3)


@pytest.fixture(scope="module")
def body() -> np.ndarray:
    return standing(3, 30.0).positions()


def test_far_from_everything_nothing_is_inside(body: np.ndarray) -> None:
    found = penetration(body, wall(3.0))
    assert (found.share, found.mean_cm, found.max_cm) == (0.0, 0.0, 0.0)


@settings(max_examples=12, deadline=None)
@given(st.floats(0.0, 0.04), st.sampled_from([0.03, 0.05, 0.1]))
def test_the_depth_is_that_of_the_nearest_limb_also_between_points(off: float, step: float) -> None:
    body = standing(2, 30.0).positions()
    hip, knee = body[0, SMPL24.index("left_hip")], body[0, SMPL24.index("left_knee")]
    body = body.copy()
    keep = [SMPL24.index("left_hip"), SMPL24.index("left_knee")]
    others = np.setdiff1d(np.arange(24), keep)
    body[:, others] = [-5.0, 1.0, 0.0]  # a leg alone, upright
    body[:, keep[0], 0] = body[:, keep[1], 0] = hip[0]
    assert np.isfinite(knee).all()
    depths = penetration_depths(body, wall(float(hip[0]) + off, step))
    np.testing.assert_allclose(depths, 100 * (THICKNESS["thigh"] - off), atol=0.2)


def test_a_share_of_the_frames_is_counted(body: np.ndarray) -> None:
    moved = np.concatenate([body, body + np.array([9.0, 0.0, 0.0])])
    found = penetration(moved, wall(0.0))
    assert found.share == pytest.approx(0.5)
    assert found.max_cm == pytest.approx(100 * THICKNESS["trunk"], abs=0.5)
    assert set(found.as_dict()) == {"share", "mean_cm", "max_cm"}


def test_hands_and_feet_may_touch(body: np.ndarray) -> None:
    hand = body[0, SMPL24.index("left_hand")]
    reach = hand + np.array([[0.0, -0.02, 0.0], [0.02, -0.02, 0.0]])
    assert penetration(body, reach).share == 0.0
    toes = body[0, SMPL24.index("left_foot")]
    assert penetration(body, toes[None]).share == 0.0


def test_a_scene_without_surfaces_is_entered_by_nobody(body: np.ndarray) -> None:
    assert penetration(body, np.zeros((0, 3))).share == 0.0
    assert penetration(body, np.array([[0.0, 9.0, 0.0]])).share == 0.0


@pytest.mark.parametrize(
    ("positions", "surfaces", "told"),
    [
        (np.zeros((0, 24, 3)), np.zeros((1, 3)), "positions"),
        (np.zeros((2, 5, 3)), np.zeros((1, 3)), "positions"),
        (np.zeros((2, 24, 3)), np.zeros((3,)), "surfaces"),
        (np.full((2, 24, 3), np.nan), np.zeros((1, 3)), "finite"),
    ],
)
def test_other_shapes_are_refused(positions: np.ndarray, surfaces: np.ndarray, told: str) -> None:
    with pytest.raises(InvalidInputError, match=told):
        penetration(positions, surfaces)
