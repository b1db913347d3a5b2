"""Smoothing of generated frames, against SciPy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d

from motionrt.synthesis.smoothing import DEVIATION, smoothed


def test_the_middle_is_what_scipy_says() -> None:
    x = np.random.default_rng(0).standard_normal((60, 4)).astype(np.float32)
    expected = gaussian_filter1d(x, DEVIATION, axis=0, radius=3)
    np.testing.assert_allclose(smoothed(x)[3:-3], expected[3:-3], atol=1e-5)


@given(slope=st.floats(-3.0, 3.0), frames=st.integers(1, 40))
def test_steady_movement_is_left_alone(slope: float, frames: int) -> None:
    x = (slope * np.arange(frames)[:, None] + 1.0).astype(np.float32)
    np.testing.assert_allclose(smoothed(x), x, atol=1e-4)


def test_the_ends_stay_and_jumps_are_spread() -> None:
    x = np.repeat(np.float32([0.0, 1.0]), 20)[:, None]
    found = smoothed(x)
    assert found[0, 0] == pytest.approx(0.0, abs=1e-6)
    assert found[-1, 0] == pytest.approx(1.0, abs=1e-6)
    assert np.abs(np.diff(found[:, 0])).max() < 0.5
    assert (np.diff(found[:, 0]) > -1e-6).all()


def test_movements_slower_than_two_a_second_keep_their_size() -> None:
    wave = np.sin(2 * np.pi * 2.0 * np.arange(90) / 30.0)[:, None].astype(np.float32)
    assert np.abs(smoothed(wave)[10:-10]).max() == pytest.approx(1.0, abs=0.08)
