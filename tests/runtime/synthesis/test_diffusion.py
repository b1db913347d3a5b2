"""The noise schedule and DDIM against closed forms: a known target, and Gaussian data, whose best denoiser is known."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from motionrt.errors import InvalidInputError
from motionrt.synthesis.diffusion import Denoise, ddim, schedule, timesteps

Array = npt.NDArray[np.float32]


def knowing(target: Array) -> Denoise:
    """A denoiser that knows the answer."""
    return lambda latent, _: (target, target)


def of_gaussian(mean: Array, std: Array) -> Denoise:
    """E[z_0 | z_t] for z_0 ~ N(mean, std^2) per dimension: the product of two Gaussians."""

    def denoise(latent: Array, time: npt.NDArray[np.int64]) -> tuple[Array, Array]:
        signal = schedule()[time][:, None]
        precision = 1.0 / std**2 + signal / (1.0 - signal)
        found = (mean / std**2 + signal**0.5 * latent / (1.0 - signal)) / precision
        return found.astype(np.float32), found.astype(np.float32)

    return denoise


def test_the_signal_falls_from_nearly_all_to_nearly_none() -> None:
    signal = schedule()
    assert signal.shape == (1000,)
    assert (np.diff(signal) < 0).all()
    assert signal[0] == pytest.approx(1 - 0.00085)
    assert signal[1] == pytest.approx((1 - 0.00085) * (1 - (0.00085**0.5 + (0.012**0.5 - 0.00085**0.5) / 999) ** 2))
    assert signal[999] == pytest.approx(0.00466, abs=1e-5)  # of Stable Diffusion, which has the same betas


@pytest.mark.parametrize(
    ("steps", "expected"),
    [(1, [999]), (2, [999, 499]), (4, [999, 749, 499, 249]), (3, [999, 666, 332])],
)
def test_time_steps_are_even_and_begin_with_the_noisiest(steps: int, expected: list[int]) -> None:
    assert timesteps(steps).tolist() == expected


def test_all_time_steps_can_be_taken() -> None:
    assert timesteps(1000).tolist() == list(range(999, -1, -1))


@pytest.mark.parametrize("steps", [0, -3, 1001])
def test_impossible_numbers_of_steps_are_refused(steps: int) -> None:
    with pytest.raises(InvalidInputError, match="between 1 and 1000"):
        timesteps(steps)


@pytest.mark.parametrize("steps", [1, 2, 10, 50])
@pytest.mark.parametrize("eta", [0.0, 1.0])
def test_a_denoiser_that_knows_the_answer_is_believed_exactly(steps: int, eta: float) -> None:
    rng = np.random.default_rng(0)
    target, noise = rng.normal(size=(2, 3, 8)).astype(np.float32)
    np.testing.assert_array_equal(ddim(knowing(target), noise, steps, eta, rng), target)


def test_between_the_steps_the_noise_stays_the_same_when_eta_is_zero() -> None:
    """With the answer known, z_t on the way is the noising of it by the very noise it began with (DDIM eq. 12)."""
    rng = np.random.default_rng(1)
    target, noise = rng.normal(size=(2, 4, 6))
    start = schedule()[999] ** 0.5 * target + (1 - schedule()[999]) ** 0.5 * noise
    seen: list[tuple[int, Array]] = []

    def denoise(latent: Array, time: npt.NDArray[np.int64]) -> tuple[Array, Array]:
        seen.append((int(time[0]), latent))
        return target.astype(np.float32), target.astype(np.float32)

    ddim(denoise, start.astype(np.float32), 5)
    assert [time for time, _ in seen] == [999, 799, 599, 399, 199]
    for time, latent in seen:
        signal = schedule()[time]
        np.testing.assert_allclose(latent, signal**0.5 * target + (1 - signal) ** 0.5 * noise, atol=1e-5)


@pytest.mark.parametrize(("steps", "eta"), [(500, 0.0), (500, 1.0), (1000, 0.5)])
def test_gaussian_data_come_out_with_their_mean_and_variance(steps: int, eta: float) -> None:
    mean, std = np.float32([0.5, -1.0, 0.0]), np.float32([0.5, 1.0, 1.6])
    rng = np.random.default_rng(2)
    data, noise = rng.standard_normal((2, 20000, 3))
    start = schedule()[999] ** 0.5 * (mean + std * data) + (1 - schedule()[999]) ** 0.5 * noise  # as data end at 999
    found = ddim(of_gaussian(mean, std), start.astype(np.float32), steps, eta, rng)
    np.testing.assert_allclose(found.mean(0), mean, atol=0.03)
    np.testing.assert_allclose(found.std(0), std, rtol=0.03)


def test_few_steps_give_a_smaller_spread_than_the_data_have() -> None:
    mean, std = np.zeros(1, np.float32), np.full(1, 0.6, np.float32)
    noise = np.random.default_rng(3).standard_normal((20000, 1)).astype(np.float32)
    spread = [float(ddim(of_gaussian(mean, std), noise, steps).std()) for steps in (1, 5, 20, 200)]
    assert spread == sorted(spread)
    assert spread[0] < 0.05  # one step gives the mean
    assert spread[-1] == pytest.approx(0.6, rel=0.03)


def test_the_answer_is_the_one_in_the_latents_own_units() -> None:
    noise = np.zeros((2, 4), np.float32)
    found = ddim(lambda latent, _: (latent, latent * 3.0 + 1.0), noise, 4)
    np.testing.assert_array_equal(found, np.ones((2, 4), np.float32))


def test_every_call_gets_float32_latents_and_one_int64_time_per_latent() -> None:
    kinds = set()

    def denoise(latent: Array, time: npt.NDArray[np.int64]) -> tuple[Array, Array]:
        kinds.add((latent.dtype.name, latent.shape, time.dtype.name, time.shape))
        return latent, latent

    ddim(denoise, np.zeros((3, 5)), 4, 0.7, np.random.default_rng(0))
    assert kinds == {("float32", (3, 5), "int64", (3,))}


def test_the_same_noise_gives_the_same_latent_and_eta_needs_a_source_of_noise() -> None:
    denoise = of_gaussian(np.zeros(4, np.float32), np.ones(4, np.float32))
    noise = np.random.default_rng(5).standard_normal((2, 4)).astype(np.float32)
    np.testing.assert_array_equal(ddim(denoise, noise, 7), ddim(denoise, noise, 7))
    one, same, other = (ddim(denoise, noise, 7, 1.0, np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 0.1
    with pytest.raises(InvalidInputError, match="default_rng"):
        ddim(denoise, noise, 7, 0.5)
    with pytest.raises(InvalidInputError, match="between 0 and 1"):
        ddim(denoise, noise, 7, 1.5, np.random.default_rng(0))
