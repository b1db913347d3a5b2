"""Inputs of the latent denoiser: latents of sentences, noised as in training."""

from __future__ import annotations

import numpy as np
import torch

from motionrt_export.examples import Feeds, Motions
from motionrt_training.networks.latent_denoiser import LatentDenoiser

STRONGEST = 4.0  # guidance


class Noised:
    """What TEMOS makes of the sentences, at any time of the noising, with guidance from 0 to 4."""

    def __init__(self, motions: Motions, model: LatentDenoiser) -> None:
        self._motions, self._model = motions, model

    @torch.no_grad()
    def __call__(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of the denoiser."""
        random = np.random.default_rng(seed)
        text = self._motions.latents(self._motions.text(batch, max(length, 4), seed))
        clean = self._model.normalise(torch.from_numpy(text))
        timestep = torch.from_numpy(random.integers(len(self._model.angle), size=batch))
        noise = torch.from_numpy(random.standard_normal(clean.shape, dtype=np.float32))
        latent = self._model.noised(clean, timestep, noise).numpy()
        guidance = random.uniform(0.0, STRONGEST, batch).astype(np.float32)
        return {"latent": latent, "timestep": timestep.numpy(), "text_latent": text, "guidance": guidance}
