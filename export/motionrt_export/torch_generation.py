"""Texts to motions with the torch modules, for `motionrt bench --against torch`.

The same steps with torch modules in the place of the sessions; with and without the text in one batch, as in training.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from motionrt.bench.generation import DECODE, decode_call, generate_calls
from motionrt.bench.timing import Call
from motionrt.models.temos import LatentDistribution
from motionrt.models.text import SentenceFeatures
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.motion_generator import MotionGenerator
from motionrt_export.examples import Array
from motionrt_export.references import Reference, denoiser_reference, motion_denoiser_reference
from motionrt_export.specs import LATENT_DENOISER
from motionrt_export.torch_locomotion import numpy, released, tensor
from motionrt_training.networks.egocentric import WIDTH
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.motion_denoiser import MotionDenoiser
from motionrt_training.networks.temos import Temos

Encode = Callable[[str], tuple[Tensor, Tensor]]  # text -> token features (1, T, 384), mask (1, T)
Load = Callable[[type[Any]], Any]  # kind of network -> the network


def make_cases(encode: Encode, folder: Path) -> dict[str, Call]:
    """A motion of a text with every sampler, and the decoder alone; ``folder`` holds the released networks."""
    generator = TorchGenerator(encode, folder)
    return {**generate_calls(generator), DECODE: decode_call(generator)}


class LoadedGenerator(Generator):
    """The generator of the runtime, moved by the torch networks that ``load`` gives."""

    def __init__(self, encode: Encode, load: Load) -> None:
        self.sentences: Any = TorchSentences(encode)
        self.temos: Any = TorchTemos(load(Temos))
        self.denoiser: Any = torch_denoiser(load(LatentDenoiser))
        self._load, self._prepared = load, True

    @cached_property
    def in_motion_space(self) -> MotionGenerator:
        """The sampler "motion"."""
        sessions: Any = TorchSessions(motion_denoiser_reference(self._load(MotionDenoiser)))
        return MotionGenerator(sessions, sentences=self.sentences)


class TorchGenerator(LoadedGenerator):
    """The same, of the released networks in a folder."""

    def __init__(self, encode: Encode, folder: Path) -> None:
        super().__init__(encode, partial(released, folder=folder))


class TorchSessions:
    """One torch module in the place of the open models."""

    def __init__(self, module: Reference) -> None:
        self._module = module

    def prepare(self, *models: str, variant: str | None = None) -> None:
        """It is open already."""

    def run(self, _model: str, outputs: Sequence[str], feeds: dict[str, Array], _variant: str | None) -> list[Array]:
        """As `motionrt.models.Sessions.run`."""
        found = self._module(feeds)
        return [found[name] for name in outputs]


class TorchSentences:
    """The sentence encoder."""

    def __init__(self, encode: Encode) -> None:
        self._encode = encode

    @torch.inference_mode()
    def encode(self, text: str) -> SentenceFeatures:
        """Features of the tokens; nobody reads the sentence embedding here."""
        features, mask = self._encode(text)
        return SentenceFeatures(numpy(features), mask.numpy(), np.zeros(features.shape[2], np.float32))


class TorchTemos:
    """Text encoder and decoder."""

    def __init__(self, model: Temos) -> None:
        self._model = model
        if not self._model.frame_mean.any():  # fresh weights: a person who stands, instead of rotations of length 0
            self._model.frame_mean[4:] = torch.tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).repeat((WIDTH - 4) // 6)

    @torch.inference_mode()
    def encode_text(self, text: SentenceFeatures) -> LatentDistribution:
        """As `motionrt.models.temos.TemosModel.encode_text`."""
        found = self._model.encode_text(tensor(text.token_features), tensor(text.attention_mask))
        return LatentDistribution(numpy(found.mu), numpy(found.logvar))

    @torch.inference_mode()
    def decode(self, latent: Array, mask: Array) -> Array:
        """As `motionrt.models.temos.TemosModel.decode`."""
        return numpy(self._model.decode(tensor(latent), tensor(mask)))


def torch_denoiser(model: LatentDenoiser) -> Callable[..., tuple[Array, Array]]:
    """As `motionrt.models.latent_denoiser.LatentDenoiser`."""
    guided = denoiser_reference(model)

    def denoise(*given: Array) -> tuple[Array, Array]:
        found = guided(dict(zip((each.name for each in LATENT_DENOISER.inputs), given, strict=True)))
        return found["clean"], found["latent_out"]

    return denoise
