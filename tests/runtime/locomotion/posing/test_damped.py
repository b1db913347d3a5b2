"""Levenberg-Marquardt against closed forms and SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

from motionrt.locomotion.posing.damped import least_squares


def valley(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rosenbrock's curved valley, whose minimum is at (1, 1)."""
    return np.array([10 * (x[1] - x[0] ** 2), 1 - x[0]]), np.array([[-20 * x[0], 10.0], [-1.0, 0.0]])


def decay(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A noisy a * exp(-b t), fitted."""
    time = np.linspace(0, 3, 20)
    seen = 2.5 * np.exp(-1.3 * time) + 0.05 * np.sin(17 * time)
    falls = np.exp(-x[1] * time)
    return x[0] * falls - seen, np.stack([falls, -x[0] * time * falls], axis=1)


def test_a_linear_problem_is_solved_as_by_the_normal_equations() -> None:
    rng = np.random.default_rng(0)
    matrix, wanted = rng.normal(size=(20, 5)), rng.normal(size=20)
    found = least_squares(lambda x: (matrix @ x - wanted, matrix), np.zeros(5), 50, close=1e-9)
    np.testing.assert_allclose(found.x, np.linalg.lstsq(matrix, wanted)[0], atol=1e-3)


def test_a_curved_valley_is_followed_to_its_end() -> None:
    found = least_squares(valley, np.array([-1.2, 1.0]), 200, close=1e-9)
    np.testing.assert_allclose(found.x, 1, atol=1e-3)
    assert found.cost == pytest.approx(0, abs=1e-6)


def test_the_minimum_is_that_of_scipy() -> None:
    expected = optimize.least_squares(lambda x: decay(x)[0], [1.0, 0.1], jac=lambda x: decay(x)[1], method="lm")
    found = least_squares(decay, np.array([1.0, 0.1]), 50, close=1e-6)
    np.testing.assert_allclose(found.x, expected.x, rtol=1e-3)
    assert found.cost == pytest.approx(expected.cost, rel=1e-4)


def test_no_more_evaluations_are_made_than_allowed_and_the_best_place_is_kept() -> None:
    asked: list[float] = []

    def watched(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rows, jacobian = valley(x)
        asked.append(0.5 * float(rows @ rows))
        return rows, jacobian

    found = least_squares(watched, np.array([-1.2, 1.0]), 6, damping=1e-3, close=1e-9)
    assert len(asked) == found.evaluations == 6
    assert found.cost == pytest.approx(min(asked))
