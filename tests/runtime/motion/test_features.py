"""The feature vectors: shapes, and exact inverses of ``sinc135`` and ``ccf219``; ``guo263`` has its own file."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import ccf219, guo263, sinc135

SEEDS = st.integers(0, 2**16)


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 30))
def test_sinc135_round_trips_22_joints_and_the_root(seed: int, frames: int) -> None:
    motion = random_motion(frames, fps=30, seed=seed)
    back = sinc135.decode(sinc135.encode(motion))
    np.testing.assert_allclose(back.rotations[:, :22], motion.rotations[:, :22], atol=1e-5)
    np.testing.assert_allclose(back.root, motion.root, atol=1e-6)


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.integers(1, 30))
def test_ccf219_round_trips_all_joints_and_the_root(seed: int, frames: int) -> None:
    motion = random_motion(frames, fps=30, seed=seed)
    back = ccf219.decode(ccf219.encode(motion))
    np.testing.assert_allclose(back.rotations, motion.rotations, atol=1e-5)
    np.testing.assert_allclose(back.root, motion.root, atol=1e-6)


@pytest.mark.parametrize(("module", "width"), [(sinc135, 135), (ccf219, 219), (guo263, 263)])
def test_feature_widths_and_dtype_are_as_named(module: ModuleType, width: int) -> None:
    features = module.encode(random_motion(7))
    assert (features.shape, features.dtype, module.WIDTH) == ((7, width), np.float32, width)


@pytest.mark.parametrize("module", [sinc135, ccf219, guo263])
@pytest.mark.parametrize("shape", [(5, 12), (0, 135), (135,)])
def test_features_of_another_shape_are_refused(module: ModuleType, shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match="features must have the shape"):
        module.decode(np.zeros(shape, np.float32))


def test_decoding_projects_predicted_matrices_to_rotations() -> None:
    noisy = ccf219.encode(random_motion(5)) + np.random.default_rng(0).normal(0, 0.05, (5, 219)).astype(np.float32)
    decoded: Motion = ccf219.decode(noisy)
    np.testing.assert_allclose(np.linalg.det(decoded.rotations), 1, atol=1e-5)
