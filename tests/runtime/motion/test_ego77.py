"""``ego77``: joints and contacts about a body that goes and turns."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24

STANDING = SMPL24.rest_positions - [0.0, SMPL24.rest_positions[:, 1].min(), 0.0]


def walked(yaw: np.ndarray, path: np.ndarray) -> np.ndarray:
    """Joints (F, 24, 3) of the rest pose carried along a path (F, 2) with headings (F,), by SciPy."""
    turned = [Rotation.from_euler("y", angle).apply(STANDING) for angle in yaw]
    return np.stack(turned) + np.stack([path[:, 0], 0 * yaw, path[:, 1]], axis=1)[:, None]


@given(st.integers(2, 40), st.integers(0, 2**31))
@settings(max_examples=30, deadline=None)
def test_joints_come_back_from_their_features_up_to_where_they_began(frames: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    joints = STANDING + np.cumsum(rng.normal(0, 0.02, (frames, 24, 3)), axis=0)
    found = ego77.decode(ego77.encode(joints))
    yaw = ego77.facing(joints)[0]
    placed = Rotation.from_euler("y", -yaw).apply((joints - joints[0, 0] * [1, 0, 1]).reshape(-1, 3))
    assert np.abs(found - placed.reshape(found.shape)).max() < 1e-4


def test_a_walk_ahead_that_turns_left_has_those_rates_in_its_first_columns() -> None:
    yaw = np.linspace(0.3, 0.3 + 40 * 0.02, 41)
    steps = 0.05 * np.stack([np.sin(yaw), np.cos(yaw)], axis=1)
    features = ego77.encode(walked(yaw, np.cumsum(steps, axis=0)))
    middle = features[5:-5]
    assert middle[:, 0] == pytest.approx(0.02, abs=1e-3)
    assert middle[:, 1] == pytest.approx(0.0, abs=2e-3)
    assert middle[:, 2] == pytest.approx(0.05, abs=2e-3)
    assert features[:, 3] == pytest.approx(STANDING[0, 1], abs=1e-6)


def test_a_step_to_the_left_is_positive_in_column_one() -> None:
    path = np.stack([np.arange(20) * 0.03, np.zeros(20)], axis=1)  # +X is left of +Z
    assert ego77.encode(walked(np.zeros(20), path))[:, 1] == pytest.approx(0.03, abs=1e-6)


def test_the_mirror_image_of_features_is_that_of_the_joints() -> None:
    rng = np.random.default_rng(3)
    joints = STANDING + np.cumsum(rng.normal(0, 0.02, (30, 24, 3)), axis=0)
    names = list(SMPL24.names)
    twins = [names.index(n.replace("left", "?").replace("right", "left").replace("?", "right")) for n in names]
    assert ego77.mirrored(ego77.encode(joints)) == pytest.approx(ego77.encode(joints[:, twins] * [-1, 1, 1]), abs=2e-5)


def test_feet_that_stand_are_in_contact_and_feet_that_are_lifted_are_not() -> None:
    joints = np.repeat(STANDING[None], 20, axis=0)
    left = [SMPL24.index("left_ankle"), SMPL24.index("left_foot")]
    joints[:, left, 1] += 0.3
    contacts = ego77.encode(joints)[:, ego77.CONTACTS]
    assert contacts.tolist() == [[0, 1, 0, 1]] * 20


def test_a_body_that_lies_on_its_side_keeps_the_heading_it_had() -> None:
    fallen = Rotation.from_euler("z", 90, degrees=True).apply(STANDING)
    joints = np.concatenate([np.repeat(STANDING[None], 20, axis=0), np.repeat(fallen[None], 20, axis=0)])
    assert ego77.facing(joints) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("shape", [(0, 24, 3), (5, 22, 3), (5, 72)])
def test_joints_of_another_shape_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match="24, 3"):
        ego77.encode(np.zeros(shape))


def test_features_of_another_width_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="77"):
        ego77.decode(np.zeros((5, 76)))
