"""Text to motion: a text's tokens, a latent drawn for them, and the motion that the decoder makes of it."""

from __future__ import annotations

from functools import cached_property, partial

import numpy as np
import numpy.typing as npt

from motionrt.models import latent_denoiser, temos
from motionrt.models.latent_denoiser import LatentDenoiser
from motionrt.models.sessions import Sessions
from motionrt.models.temos import LATENT, TemosModel
from motionrt.models.text import MODEL as SENTENCES
from motionrt.models.text import FloatArray, SentenceEncoder, checked_text
from motionrt.motion import Motion
from motionrt.motion.features import sinc135
from motionrt.synthesis.diffusion import ddim
from motionrt.synthesis.finishing import finished
from motionrt.synthesis.motion_generator import MotionGenerator, Wanted
from motionrt.synthesis.sampling import Sampling
from motionrt.synthesis.smoothing import smoothed
from motionrt.synthesis.timeline import lines_of_text

PADDING = 20  # frames: the decoder sees multiples of them only, so that 12 lengths are all it ever has memory for


class Generator:
    """Makes motions of texts; every model opens when it is first needed.

    Samples go through the models one by one: they come out the same, bit for bit, alone and among others.

    Args:
        sessions: open models.
        variant: which files, as in ``fp32``; by default those that the manifest prefers.
        sentences: the sentence encoder, where there is one already.
    """

    def __init__(
        self, sessions: Sessions, variant: str | None = None, *, sentences: SentenceEncoder | None = None
    ) -> None:
        self.temos = TemosModel(sessions, variant)
        self.denoiser = LatentDenoiser(sessions, variant)
        self.sentences = sentences or SentenceEncoder(sessions, variant)
        self._prepared = False

    def generate(self, text: str, sampling: Sampling | None = None) -> list[Motion]:
        """``sampling.n`` motions of a text: 30 fps, from above the origin, facing +Z, feet on the floor.

        Raises:
            InvalidInputError: an empty text.
            ModelNotFoundError, ModelFileError: the models are not there.
        """
        how = sampling or Sampling()
        checked_text(text)  # before a model is opened for it
        if how.sampler == "motion":
            return self.in_motion_space.generate(Wanted(lines_of_text(text, how.seconds)), how)
        self._prepare(how.sampler)
        return [finished(motion, how.foot_lock) for motion in self.decode(self.latents(text, how), how.frames)]

    @cached_property
    def in_motion_space(self) -> MotionGenerator:
        """The sampler "motion", with the same sessions."""
        return MotionGenerator(self.temos.sessions, self.temos.variant, sentences=self.sentences)

    def latents(self, text: str, sampling: Sampling) -> FloatArray:
        """``(n, 256)`` float32 latents of TEMOS drawn for a text; sample ``i`` is the same for every ``n``."""
        features = self.sentences.encode(text)
        noise = np.stack([sampling.noise(sample, LATENT) for sample in range(sampling.n)])
        told = self.temos.encode_text(features)
        if sampling.sampler == "vae":
            return told.at(noise)
        denoise = partial(self._denoise, told.mu, sampling.weight)
        return np.concatenate([ddim(denoise, row[None], sampling.calls) for row in noise])

    def decode(self, latents: FloatArray, frames: int) -> list[Motion]:
        """The motions of latents ``(n, 256)`` as the decoder gives them, smoothed; rotations are made proper ones."""
        mask = np.zeros((1, -(-frames // PADDING) * PADDING), bool)
        mask[:, :frames] = True
        return [sinc135.decode(smoothed(self.temos.decode(row[None], mask)[0, :frames])) for row in latents]

    def _denoise(
        self, text: FloatArray, guidance: float, latent: FloatArray, timestep: npt.NDArray[np.int64]
    ) -> tuple[FloatArray, FloatArray]:
        weights = np.full(len(latent), guidance, np.float32)
        return self.denoiser(latent, timestep, np.repeat(text, len(latent), axis=0), weights)

    def _prepare(self, sampler: str) -> None:
        """Let the models open side by side, the first time."""
        if not self._prepared:
            self._prepared = True
            drawing = [] if sampler == "vae" else [latent_denoiser.DENOISER]
            self.temos.sessions.prepare(SENTENCES, temos.TEXT, *drawing, temos.DECODER, variant=self.temos.variant)
