"""Latent diffusion: the noise schedule and DDIM sampling; the network that estimates is the caller's.

A latent z_0 is normalised (zero mean, unit variance over the training data). Noise is added to it as
z_t = sqrt(a_t) z_0 + sqrt(1 - a_t) e, with e standard normal and a_t the ``schedule`` at time step t
(Ho et al. 2020, eq. 4; DDIM, Song et al. 2021, writes alpha_t for it). Training takes the schedule from here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray

STEPS = 1000  # time steps of the noising; 0 has the least noise
FIRST_BETA, LAST_BETA = 0.00085, 0.012  # MLD (Chen et al. 2023)

Denoise = Callable[[FloatArray, npt.NDArray[np.int64]], tuple[FloatArray, FloatArray]]
"""(noisy latent z_t (B, D), time step (B,)) -> estimate of z_0 (B, D), and the same denormalised (B, D)."""


def schedule() -> npt.NDArray[np.float64]:
    """The part of the variance that is signal, a_t, at every time step: (1000,), falling.

    Products of 1 - beta, whose square roots grow evenly ("scaled linear", as in MLD).
    """
    roots = np.linspace(FIRST_BETA**0.5, LAST_BETA**0.5, STEPS, dtype=np.float64)
    return np.cumprod(1.0 - np.square(roots), dtype=np.float64)


def timesteps(steps: int) -> npt.NDArray[np.int64]:
    """``steps`` evenly spaced time steps, falling, the first one always 999 ("trailing": Lin et al. 2024, table 2).

    Raises:
        InvalidInputError: not between 1 and 1000.
    """
    if not 1 <= steps <= STEPS:
        raise InvalidInputError(f"steps must be between 1 and {STEPS}, not {steps}")
    return np.round(np.arange(steps, 0, -1) * (STEPS / steps)).astype(np.int64) - 1


def ddim(
    denoise: Denoise, noise: FloatArray, steps: int = 10, eta: float = 0.0, rng: np.random.Generator | None = None
) -> FloatArray:
    """Draw latents: noise ``(B, D)``, standard normal, becomes latents ``(B, D)`` float32 (DDIM eq. 12).

    Args:
        denoise: the estimate of the clean latent, called once per step.
        noise: where the drawing starts; with ``eta`` 0 it alone decides what comes out.
        steps: calls of ``denoise``.
        eta: new noise per step: 0 for none, 1 for as much as in DDPM (DDIM eq. 16).
        rng: source of that noise; needed when ``eta`` is not 0.

    Returns:
        The second answer of the last call of ``denoise``: no noise is left behind the last step.

    Raises:
        InvalidInputError: ``steps`` or ``eta`` out of range, or no ``rng`` for an ``eta`` above 0.
    """
    if not 0.0 <= eta <= 1.0:
        raise InvalidInputError(f"eta must be between 0 and 1, not {eta}")
    if eta and rng is None:
        raise InvalidInputError("eta above 0 draws noise at every step; give rng=np.random.default_rng(seed)")
    times = timesteps(steps)
    signal = schedule()[times]
    latent = np.asarray(noise, np.float32)
    clean, out = _estimate(denoise, latent, times[0])
    for k in range(1, steps):
        fresh = rng.standard_normal(latent.shape) if eta and rng else 0.0
        latent = _step(latent, clean, signal[k - 1], signal[k], eta, fresh)
        clean, out = _estimate(denoise, latent, times[k])
    return out


def _estimate(denoise: Denoise, latent: FloatArray, time: np.int64) -> tuple[FloatArray, FloatArray]:
    return denoise(latent, np.full(len(latent), time, np.int64))


def _step(
    latent: FloatArray,
    clean: FloatArray,
    now: float,
    then: float,
    eta: float,
    fresh: float | npt.NDArray[np.float64],
) -> FloatArray:
    """From z at signal ``now`` to z at the larger signal ``then``, given the estimate of z_0 (DDIM eq. 12 and 16)."""
    noise = (latent - now**0.5 * clean) / (1.0 - now) ** 0.5
    sigma = eta * ((1.0 - then) / (1.0 - now) * (1.0 - now / then)) ** 0.5
    ahead = then**0.5 * clean + (1.0 - then - sigma**2) ** 0.5 * noise + sigma * fresh
    return np.asarray(ahead, np.float32)
