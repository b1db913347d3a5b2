"""Runs of true values in several columns, against a loop over them."""

from __future__ import annotations

from itertools import groupby

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from motionrt.motion.runs import Runs

FLAGS = arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 4)))


def looped(flags: np.ndarray) -> list[tuple[int, int, int]]:
    """(column, start, stop) of every run."""
    found = []
    for column, values in enumerate(flags.T):
        for value, group in groupby(enumerate(values), key=lambda pair: bool(pair[1])):
            frames = [frame for frame, _ in group]
            found += [(column, frames[0], frames[-1] + 1)] if value else []
    return found


@given(FLAGS)
def test_runs_are_those_of_a_loop(flags: np.ndarray) -> None:
    runs, expected = Runs.of(flags), looped(flags)
    frames = len(flags)
    assert runs.starts.tolist() == [column * frames + start for column, start, _ in expected]
    assert runs.stops.tolist() == [column * frames + stop for column, _, stop in expected]
    assert runs.first.tolist() == [start == 0 for _, start, _ in expected]
    assert runs.last.tolist() == [stop == frames for _, _, stop in expected]


@given(FLAGS)
def test_values_of_runs_come_back_to_their_frames(flags: np.ndarray) -> None:
    runs = Runs.of(flags)
    np.testing.assert_array_equal(runs.flags(np.ones(len(runs.starts), bool)), flags)
    np.testing.assert_array_equal(runs.flat(flags)[runs.inside], True)
    np.testing.assert_array_equal(runs.shaped(runs.flat(flags)), flags)


@given(FLAGS)
def test_weighted_means_are_those_of_numpy(flags: np.ndarray) -> None:
    rng = np.random.default_rng(0)
    values, weights = rng.normal(size=(*flags.shape, 3)), rng.uniform(0.1, 1, flags.shape)
    runs = Runs.of(flags)
    found = runs.mean(runs.flat(values)[runs.inside], runs.flat(weights)[runs.inside])
    expected = [
        np.average(values[start:stop, column], axis=0, weights=weights[start:stop, column])
        for column, start, stop in looped(flags)
    ]
    np.testing.assert_allclose(found, np.reshape(expected, (-1, 3)))
