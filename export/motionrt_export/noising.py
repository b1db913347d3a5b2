"""Inputs of the denoisers: latents of sentences, and motions told by sentences, noised as in training."""

from __future__ import annotations

import numpy as np
import torch

from motionrt.text import SLOTS, TARGETS
from motionrt_export.examples import Feeds, Motions, Sentences
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.motion_denoiser import MotionDenoiser

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


class NoisyMotions:
    """Noise of every level about the mean motion, told by sentences and random slots, some frames held."""

    def __init__(self, sentences: Sentences, backbone: MiniLM, model: MotionDenoiser) -> None:
        self._motions, self._model = Motions(sentences, backbone, model), model

    def __call__(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of the denoiser."""
        random = np.random.default_rng(seed)
        level = np.exp(random.uniform(-2.5, 4.0, batch)).astype(np.float32)
        shape = batch, length, self._model.width
        normal = [random.standard_normal(shape, dtype=np.float32) for _ in range(2)]
        return {
            "noisy": (1 + level[:, None, None]) * normal[0],
            "level": level,
            "mask": np.ones((batch, length), bool),
            **self._motions.text(batch, 12, seed),
            "slots": np.stack([random.integers(count, size=batch) for count in SLOTS.values()], axis=1),
            "numbers": random.uniform(-1, 1, (batch, len(TARGETS))).astype(np.float32),
            "known": random.random((batch, len(TARGETS))) < 0.2,
            "held": self._model.denormalise(torch.from_numpy(normal[1])).numpy(),
            "holding": random.random((batch, length, 6)) < 0.1,
            "guidance": random.uniform(1.0, STRONGEST, (batch, 2)).astype(np.float32),
        }
