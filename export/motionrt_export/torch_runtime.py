"""The runtime moved by torch: the same verbs, with a torch module wherever a session would be asked."""

from __future__ import annotations

from functools import cached_property
from typing import Any, cast

import numpy as np
import torch
from torch import Tensor

from motionrt import Runtime
from motionrt.locomotion.character_models import OnnxCharacterModels
from motionrt.models.pose_prior import PosePrior
from motionrt.models.temos import LatentDistribution
from motionrt.models.text import SentenceFeatures
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.motion_generator import MotionGenerator
from motionrt_export import references
from motionrt_export.calibration import sentence_ids
from motionrt_export.examples import Array
from motionrt_export.references import Reference
from motionrt_export.sources import Sources
from motionrt_export.specs import LATENT_DENOISER
from motionrt_export.torch_generation import TorchSentences, TorchSessions


class TorchRuntime(Runtime):
    """Walks, acts, generates and composes with the released networks."""

    def __init__(self, sources: Sources) -> None:
        super().__init__()
        self._sources = sources

    @cached_property
    def character_models(self) -> OnnxCharacterModels:
        """WalkNet, TransNet and the pose prior in torch."""
        return TorchPlayers(self._sources)

    @cached_property
    def generator(self) -> Generator:
        """Text to motion in torch."""
        return TorchGenerator(self._sources)


class TorchPlayers(OnnxCharacterModels):
    """The models that move a character."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources

    @cached_property
    def walk(self) -> Any:
        """WalkNet at stride 1: the first of the 30 frames that it predicts."""
        step = references.walk_reference(self._sources.walknet.model)
        return lambda frames, speed: step({"frames": frames, "speed": np.array(speed)})["next"]

    @cached_property
    def infill(self) -> Any:
        """TransNet."""
        fill = references.transition_reference(self._sources.transnet.model)
        return lambda frames, hidden: fill({"frames": frames, "hidden": hidden})["motion"]

    @cached_property
    def prior(self) -> PosePrior:
        """The pose prior."""
        decode = references.pose_reference(self._sources.pose_prior.model)
        return PosePrior(lambda rows: decode({"latent": rows})["rotations"])


class TorchGenerator(Generator):
    """The generator; its models are there already."""

    def __init__(self, sources: Sources) -> None:
        self.sentences: Any = TorchSentences(_encode(sources))
        self.temos: Any = TorchTemos(sources)
        self.denoiser: Any = _denoise(references.denoiser_reference(sources.latent_denoiser.model))
        self._prepared = True
        self._sources = sources

    @cached_property
    def in_motion_space(self) -> MotionGenerator:
        """The sampler "motion"."""
        reference = references.motion_denoiser_reference(self._sources.motion_denoiser.model)
        return MotionGenerator(cast("Any", TorchSessions(reference)), sentences=self.sentences)


class TorchTemos:
    """As `motionrt.models.temos.TemosModel`, without its checks."""

    def __init__(self, sources: Sources) -> None:
        model = sources.temos.model
        self._text, self._decode = references.temos_text_reference(model), references.temos_decoder_reference(model)

    def encode_text(self, text: SentenceFeatures) -> LatentDistribution:
        """The distribution of a text."""
        found = self._text({"token_features": text.token_features, "attention_mask": text.attention_mask})
        return LatentDistribution(found["mu"], found["logvar"])

    def decode(self, latent: Array, mask: Array) -> Array:
        """Raw features of latents."""
        return self._decode({"latent": latent, "mask": mask})["motion"]


def _encode(sources: Sources) -> Any:
    ids_of = sentence_ids(sources.tokenizer_file)

    def encode(text: str) -> tuple[Tensor, Tensor]:
        ids = torch.tensor([ids_of(text)])
        mask = torch.ones_like(ids)
        return sources.backbone(ids, mask), mask

    return encode


def _denoise(guided: Reference) -> Any:
    def denoise(*given: Array) -> tuple[Array, Array]:
        found = guided(dict(zip((each.name for each in LATENT_DENOISER.inputs), given, strict=True)))
        return found["clean"], found["latent_out"]

    return denoise
