"""The runtime moved by torch: the same verbs, with a torch module wherever a session would be asked."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import torch
from torch import Tensor

from motionrt import Runtime
from motionrt.locomotion.character_models import OnnxCharacterModels
from motionrt.models.pose_prior import PosePrior
from motionrt.synthesis.generating import Generator
from motionrt_export import references
from motionrt_export.calibration import sentence_ids
from motionrt_export.sources import Sources
from motionrt_export.torch_generation import LoadedGenerator
from motionrt_training.networks.walknet import WISHES


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
        return LoadedGenerator(_encode(self._sources), lambda network: self._sources.load(network)[0])


class TorchPlayers(OnnxCharacterModels):
    """The models that move a character."""

    def __init__(self, sources: Sources) -> None:
        self._sources = sources

    @cached_property
    def walk(self) -> Any:
        """WalkNet at stride 1: the first of the 30 frames that it predicts."""
        step = references.walk_reference(self._sources.walknet.model)

        def walk(frames: Any, speed: Any, wish: Any = None) -> Any:
            told = np.zeros((len(frames), WISHES), np.float32) if wish is None else wish
            return step({"frames": frames, "speed": np.array(speed), "wish": told})["next"]

        walk.wishes = True  # type: ignore[attr-defined]
        return walk

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


def _encode(sources: Sources) -> Any:
    ids_of = sentence_ids(sources.tokenizer_file)

    def encode(text: str) -> tuple[Tensor, Tensor]:
        ids = torch.tensor([ids_of(text)])
        mask = torch.ones_like(ids)
        return sources.backbone(ids, mask), mask

    return encode
