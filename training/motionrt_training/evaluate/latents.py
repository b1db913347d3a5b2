"""The one interface to TEMOS that is evaluated: a torch checkpoint, or the exported models."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Protocol

import numpy as np
import torch

from motionrt.models import SentenceEncoder, Sessions
from motionrt.models.temos import TemosModel
from motionrt.models.text import SentenceFeatures
from motionrt.motion import Motion
from motionrt.motion.features import sinc135
from motionrt.motion.skeleton import FloatArray
from motionrt_training.backbones import Backbone
from motionrt_training.checkpoint import load_any
from motionrt_training.networks.temos import Temos
from motionrt_training.temos_data import separated


class Latents(Protocol):
    """Texts and motions as normal distributions of latents, and motions out of latents."""

    def text(self, *texts: str) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation ``(d,)`` of a text, or of several whose token features stand in a row (STE)."""

    def motion(self, motion: Motion) -> FloatArray:
        """Mean ``(d,)`` of a motion at 30 fps."""

    def decode(self, latent: FloatArray, frames: int) -> Motion:
        """The motion at 30 fps of a latent ``(d,)``."""


class TorchLatents:
    """A Temos module, fed with the token features of a frozen backbone."""

    def __init__(self, model: Temos, backbone: Backbone) -> None:
        self._model = model.eval()
        self._tokens = lru_cache(maxsize=512)(lambda text: torch.from_numpy(backbone.encode(text)[0])[None].float())

    @torch.inference_mode()
    def text(self, *texts: str) -> tuple[FloatArray, FloatArray]:
        """Mean and log variance of what texts mean, in one sentence where they are several."""
        parts = [self._tokens(text)[0].numpy() for text in texts]
        rows = separated(parts) if "separation" in self._model.config else np.concatenate(parts)
        tokens = torch.from_numpy(rows)[None]  # (1, T, 384)
        found = self._model.encode_text(tokens, torch.ones(tokens.shape[:2], dtype=torch.bool))
        return found.mu[0].numpy(), (0.5 * found.logvar[0]).exp().numpy()

    @torch.inference_mode()
    def motion(self, motion: Motion) -> FloatArray:
        """The latent of a motion."""
        x = torch.from_numpy(sinc135.encode(motion))[None]
        return np.asarray(self._model.encode_motion(x, torch.ones(x.shape[:2], dtype=torch.bool)).mu[0].numpy())

    @torch.inference_mode()
    def decode(self, latent: FloatArray, frames: int) -> Motion:
        """The motion of a latent, so many frames at 30 fps."""
        mask = torch.ones((1, frames), dtype=torch.bool)
        rows = torch.from_numpy(np.ascontiguousarray(latent, np.float32))[None]
        return sinc135.decode(self._model.decode(rows, mask)[0].numpy())


class ExportedLatents:
    """The exported graphs."""

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self._sentences, self._model = SentenceEncoder(sessions), TemosModel(sessions, variant)

    def text(self, *texts: str) -> tuple[FloatArray, FloatArray]:
        """Mean and log variance of what texts mean, in one sentence where they are several."""
        encoded = [self._sentences.encode(text) for text in texts]
        tokens = np.concatenate([one.token_features for one in encoded], axis=1)
        mask = np.ones(tokens.shape[:2], np.int64)
        found = self._model.encode_text(SentenceFeatures(tokens, mask, encoded[0].sentence_embedding))
        return found.mu[0], np.asarray(np.exp(found.logvar[0] / 2))

    def motion(self, motion: Motion) -> FloatArray:
        """The latent of a motion."""
        return np.asarray(self._model.encode_motion(sinc135.encode(motion)[None]).mu[0])

    def decode(self, latent: FloatArray, frames: int) -> Motion:
        """The motion of a latent, so many frames at 30 fps."""
        return sinc135.decode(self._model.decode(latent[None], np.ones((1, frames), bool))[0])


def load_latents(path: str | Path, backbone: Backbone) -> Latents:
    """A checkpoint (``best.pt``, ``last.pt``, ``.safetensors``), or exported models by their manifest (``.yaml``)."""
    if Path(path).suffix in (".yaml", ".yml"):
        return ExportedLatents(Sessions(path))
    return TorchLatents(load_any(path, Temos), backbone)


def drawn(model: Latents, texts: Sequence[str], samples: int, rng: np.random.Generator) -> Iterator[FloatArray]:
    """The mean latent ``(d,)`` of a text, or of several encoded separately, then ``samples`` draws."""
    mean, spread = model.text(*texts)
    yield mean
    for _ in range(samples):
        yield (mean + spread * rng.standard_normal(len(mean))).astype(np.float32)
