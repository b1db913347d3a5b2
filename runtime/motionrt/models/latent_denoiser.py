"""The denoiser of latent diffusion: the clean TEMOS latent in a noisy one, told by that of a text."""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models.sessions import Arrays, Sessions
from motionrt.models.temos import checked_latents
from motionrt.models.text import FloatArray, IntArray

DENOISER = "latent_denoiser"
OUTPUTS = ("clean", "latent_out")  # the estimate, normalised, and in the units of TEMOS
TIMESTEPS = 1000  # of the noise schedule


class LatentDenoiser:
    """Estimates clean latents; any number of rows in one call, under the caveat of :class:`TemosModel`.

    Args:
        sessions: open models.
        variant: which file, e.g. ``fp32``; by default what the manifest says.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    def __call__(
        self,
        latent: FloatArray,
        timestep: IntArray,
        text_latent: FloatArray,
        guidance: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Estimates of the clean latents ``(B, 256)`` float32: normalised, and the same in the units of TEMOS.

        Args:
            latent: ``(B, 256)`` noisy latents, normalised: pure noise is standard normal.
            timestep: ``(B,)`` whole numbers from 0 (hardly any noise) to 999 (nothing else).
            text_latent: ``(B, 256)`` means of the texts' latents, in the units of TEMOS.
            guidance: ``(B,)`` weights of classifier-free guidance; 1 is the plain estimate, 0 that without a text.

        Raises:
            InvalidInputError: another shape, a latent that is not finite, or a timestep out of range.
        """
        rows, texts = checked_latents(latent), checked_latents(text_latent)
        steps, weights = np.asarray(timestep, np.int64), np.asarray(guidance, np.float32)
        if len(rows) != len(texts) or not steps.shape == weights.shape == (len(rows),):
            found = f"{rows.shape}, {steps.shape}, {texts.shape} and {weights.shape}"
            raise InvalidInputError(f"latent, timestep, text latent and guidance need one row each: {found}")
        if ((steps < 0) | (steps >= TIMESTEPS)).any():
            raise InvalidInputError(f"timesteps lie between 0 and {TIMESTEPS - 1}, not {steps.tolist()}")
        feeds: Arrays = {"latent": rows, "timestep": steps, "text_latent": texts, "guidance": weights}
        normalised, raw = self.sessions.run(DENOISER, list(OUTPUTS), feeds, self.variant)
        return normalised, raw
