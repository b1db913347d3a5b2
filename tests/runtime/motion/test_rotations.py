"""Rotation functions against SciPy's Rotation."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.linalg import polar
from scipy.spatial.transform import Rotation, Slerp

from motionrt.errors import InvalidInputError
from motionrt.motion import rotations as r

ORDERS = ["".join(order) for order in itertools.permutations("XYZ")]
VECTORS = arrays(np.float64, (5, 3), elements=st.floats(-3, 3, allow_nan=False, width=32))


def random_rotations(count: int = 200, seed: int = 0) -> Rotation:
    return Rotation.random(count, random_state=np.random.default_rng(seed))


@pytest.mark.parametrize("order", ORDERS)
def test_euler_angles_compose_in_channel_order_like_scipy_intrinsic(order: str) -> None:
    angles = np.random.default_rng(1).uniform(-3, 3, (100, 3))
    expected = Rotation.from_euler(order, angles).as_matrix()
    np.testing.assert_allclose(r.euler_to_matrix(angles, order), expected, atol=1e-12)


@pytest.mark.parametrize("order", ORDERS)
def test_euler_angles_round_trip_through_matrices(order: str) -> None:
    matrices = random_rotations().as_matrix()
    np.testing.assert_allclose(r.euler_to_matrix(r.matrix_to_euler(matrices, order), order), matrices, atol=1e-6)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("middle", [np.pi / 2, -np.pi / 2])
def test_euler_angles_at_gimbal_lock_still_give_the_same_rotation(order: str, middle: float) -> None:
    matrix = Rotation.from_euler(order, [0.3, middle, -0.7]).as_matrix()
    np.testing.assert_allclose(r.euler_to_matrix(r.matrix_to_euler(matrix, order), order), matrix, atol=1e-6)


@pytest.mark.parametrize("order", ["", "XQ", "XYZ"])
def test_euler_order_that_does_not_fit_the_angles_is_refused(order: str) -> None:
    with pytest.raises(InvalidInputError, match="one angle per axis"):
        r.euler_to_matrix(np.zeros((4, 2)), order)


@given(VECTORS)
def test_axis_angle_matches_scipy_and_round_trips(vectors: np.ndarray) -> None:
    matrices = r.axis_angle_to_matrix(vectors)
    np.testing.assert_allclose(matrices, Rotation.from_rotvec(vectors).as_matrix(), atol=1e-9)
    np.testing.assert_allclose(r.axis_angle_to_matrix(r.matrix_to_axis_angle(matrices)), matrices, atol=1e-6)


def test_quaternions_match_scipy_and_have_a_positive_real_part() -> None:
    rotations = random_rotations(1000)
    wxyz = r.matrix_to_quaternion(rotations.as_matrix())
    np.testing.assert_allclose(wxyz, rotations.as_quat(canonical=True, scalar_first=True), atol=1e-9)
    np.testing.assert_allclose(r.quaternion_to_matrix(wxyz * 7.0), rotations.as_matrix(), atol=1e-12)


def test_half_turns_convert_to_quaternions_without_loss() -> None:
    matrices = Rotation.from_rotvec(np.pi * np.eye(3)).as_matrix()
    np.testing.assert_allclose(r.quaternion_to_matrix(r.matrix_to_quaternion(matrices)), matrices, atol=1e-12)


@given(arrays(np.float64, (4, 6), elements=st.floats(-2, 2, width=32)))
def test_6d_of_any_independent_columns_is_a_rotation(sixd: np.ndarray) -> None:
    sixd = sixd + np.array([5, 0, 0, 0, 5, 0])  # keeps the two columns independent
    matrices = r.matrix_from_6d(sixd)
    identity = np.broadcast_to(np.eye(3), (4, 3, 3))
    np.testing.assert_allclose(matrices @ np.swapaxes(matrices, -1, -2), identity, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(matrices), 1, atol=1e-9)
    np.testing.assert_allclose(r.matrix_from_6d(r.matrix_to_6d(matrices)), matrices, atol=1e-9)


@given(VECTORS, VECTORS)
def test_rotation_between_turns_one_direction_into_the_other(source: np.ndarray, target: np.ndarray) -> None:
    source[np.linalg.norm(source, axis=1) < 1e-3] = [1, 0, 0]
    target[np.linalg.norm(target, axis=1) < 1e-3] = [0, 1, 0]
    turned = (r.rotation_between(source, target) @ r.normalise(source)[..., None])[..., 0]
    np.testing.assert_allclose(turned, r.normalise(target), atol=1e-5)


def test_rotation_between_is_the_smallest_and_survives_opposite_directions() -> None:
    quarter = r.rotation_between([1.0, 0, 0], [0, 2.0, 0])
    np.testing.assert_allclose(Rotation.from_matrix(quarter).as_rotvec(), [0, 0, np.pi / 2], atol=1e-9)
    half = r.rotation_between([0, 0, 1.0], [0, 0, -1.0])
    np.testing.assert_allclose(half @ [0, 0, 1.0], [0, 0, -1], atol=1e-9)
    assert np.linalg.det(half) == pytest.approx(1)


def test_projection_to_so3_gives_the_nearest_rotation() -> None:
    matrices = random_rotations(50).as_matrix()
    noisy = matrices + np.random.default_rng(3).normal(0, 0.02, matrices.shape)
    projected = r.project_to_so3(noisy)
    np.testing.assert_allclose(projected, [polar(matrix)[0] for matrix in noisy], atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(projected), 1, atol=1e-9)
    assert np.linalg.det(r.project_to_so3(np.diag([1.0, 1.0, -1.0]))) == pytest.approx(1)


def test_slerp_matches_scipy_on_every_weight_and_takes_the_short_way() -> None:
    pair = random_rotations(2, seed=5)
    weights = np.linspace(0, 1, 11)
    expected = Slerp([0, 1], pair)(weights).as_matrix()
    start, end = pair.as_quat(scalar_first=True)
    for sign in (1, -1):
        blended = r.slerp(np.tile(start, (11, 1)), np.tile(sign * end, (11, 1)), weights)
        np.testing.assert_allclose(r.quaternion_to_matrix(blended), expected, atol=1e-9)


def test_yaw_is_measured_from_plus_z_towards_plus_x() -> None:
    directions = [[0, 0, 1], [1, 5, 0], [0, 0, -1], [-2, 0, 0]]
    np.testing.assert_allclose(r.yaw_angle(directions), [0, np.pi / 2, np.pi, -np.pi / 2])


@pytest.mark.parametrize("count", [1, 24, 3000])
@pytest.mark.parametrize("noise", [0.01, 0.1, 1.0])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_projection_is_that_of_the_singular_value_decomposition(count: int, noise: float, dtype: type) -> None:
    rng = np.random.default_rng(count)
    rotations = Rotation.random(count, random_state=rng).as_matrix()
    matrices = (rotations + rng.normal(0, noise, (count, 3, 3))).astype(dtype)
    u, _, vt = np.linalg.svd(matrices.astype(np.float64))
    flip = np.ones((count, 3))
    flip[:, 2] = np.linalg.det(u @ vt)
    found = r.project_to_so3(matrices)
    assert found.dtype == dtype
    well = noise < 1 or dtype is np.float64  # near to a reflection the nearest rotation is anybody's guess
    np.testing.assert_allclose(
        found, (u * flip[:, None]) @ vt, atol=(1e-7 if dtype is np.float32 else 1e-9) if well else 1e-4
    )


def test_reflections_and_singular_matrices_are_projected_too() -> None:
    for count in (3, 500):
        matrices = np.concatenate([np.tile(np.diag([1.0, 1.0, -1.0]), (count, 1, 1)), np.zeros((2, 3, 3))])
        np.testing.assert_allclose(r.project_to_so3(matrices), np.tile(np.eye(3), (count + 2, 1, 1)), atol=1e-12)
    assert r.project_to_so3(np.zeros((0, 3, 3))).shape == (0, 3, 3)


def test_the_smallest_turn_between_opposite_directions_is_half_a_turn() -> None:
    source = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    turns = r.rotation_between(source, source * np.array([[-1.0], [-1.0], [1.0]]))
    np.testing.assert_allclose((turns @ source[..., None])[..., 0], source * [[-1.0], [-1.0], [1.0]], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turns), 1)
