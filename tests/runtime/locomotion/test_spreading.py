"""Batches shared out among threads: the same answers, in the same order."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from motionrt.errors import InvalidInputError
from motionrt.locomotion.spreading import Spread, pieces


def double(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
    return 2 * frames[:, -1] + speed[:, None]


@pytest.mark.parametrize("characters", [1, 2, 7, 64])
def test_the_answer_is_that_of_the_model(characters: int) -> None:
    random = np.random.default_rng(characters)
    frames, speed = random.normal(size=(characters, 30, 219)), random.normal(size=characters)
    np.testing.assert_array_equal(Spread(double, threads=2)(frames, speed), double(frames, speed))


def test_two_threads_work_at_the_same_time() -> None:
    both = threading.Barrier(2, timeout=10)

    def meet(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        both.wait()  # goes on only when another call of the model waits here, too
        return double(frames, speed)

    assert Spread(meet, threads=2)(np.zeros((8, 30, 219)), np.ones(8)).shape == (8, 219)


@pytest.mark.parametrize(
    ("characters", "threads", "expected"), [(1, 2, 1), (7, 2, 1), (8, 1, 1), (8, 2, 2), (9, 4, 2), (64, 2, 2)]
)
def test_every_thread_has_one_piece_of_four_at_least(characters: int, threads: int, expected: int) -> None:
    assert pieces(characters, threads) == expected


def test_errors_of_the_model_reach_the_caller() -> None:
    def broken(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        raise InvalidInputError("not like this")

    with pytest.raises(InvalidInputError, match="not like this"):
        Spread(broken, threads=2)(np.zeros((8, 30, 219)), np.ones(8))


def test_a_number_of_threads_that_is_none_is_refused() -> None:
    with pytest.raises(InvalidInputError):
        Spread(double, threads=0)
