"""The torch modules that an exported graph must equal, called with the graph's own inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import torch
from torch import Tensor

from motionrt_export.motion_graphs import WalkNetGraph
from motionrt_export.specs import LATENT_DENOISER, MOTION_DENOISER
from motionrt_training.networks.actor import Distribution
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.minilm import MiniLM, mean_pooled
from motionrt_training.networks.motion_denoiser import Condition, MotionDenoiser
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet

Arrays = Mapping[str, np.ndarray[Any, Any]]
Reference = Callable[[Arrays], dict[str, np.ndarray[Any, Any]]]


def text_reference(backbone: MiniLM, model: TMR) -> Reference:
    """Embedding and latent of tokens, their features, and the sentence embedding."""

    def run(ids: Tensor, mask: Tensor) -> dict[str, Tensor]:
        features = backbone(ids, mask)
        sentence = {"token_features": features, "sentence_embedding": mean_pooled(features, mask)}
        return {**_encoded(model.encode_text(features, mask)), **sentence}

    return _reference(run, "input_ids", "attention_mask")


def student_reference(model: TextStudent) -> Reference:
    """Embedding of tokens by the small text tower, and the vector in its direction."""

    def run(ids: Tensor, mask: Tensor) -> dict[str, Tensor]:
        latent = model(ids, mask)
        return {"embedding": torch.nn.functional.normalize(latent, dim=-1), "latent": latent}

    return _reference(run, "input_ids", "attention_mask")


def motion_reference(model: TMR) -> Reference:
    """Embedding and latent of raw features."""
    return _reference(lambda x, mask: _encoded(model.encode_motion(x, mask)), "motion", "mask")


def decoder_reference(model: TMR) -> Reference:
    """Raw features of a latent."""
    return _reference(lambda z, mask: {"motion": model.decode(z, mask)}, "latent", "mask")


def walk_reference(model: WalkNet) -> Reference:
    """The first frame that is predicted."""
    return _walking(lambda *told: model(*told)[:, 0], model)


def step_reference(model: WalkNet) -> Reference:
    """The same at half the cost, for inputs: the module that is exported."""
    return _walking(WalkNetGraph(model), model)


def _walking(step: Callable[..., Tensor], model: WalkNet) -> Reference:
    """A step that is told wishes if the network knows them."""
    names = ("frames", "speed", "wish") if model.wishes else ("frames", "speed")
    return _reference(lambda *told: {"next": step(*told)}, *names)


def transition_reference(model: TransNet) -> Reference:
    """All frames, the hidden ones filled."""
    return _reference(lambda frames, hidden: {"motion": model(frames, hidden)}, "frames", "hidden")


def pose_reference(model: PosePrior) -> Reference:
    """Rotations of a latent."""
    return _reference(lambda latent: {"rotations": model.decode(latent)}, "latent")


def temos_text_reference(model: Temos) -> Reference:
    """Distribution of token features."""
    return _reference(lambda x, mask: model.encode_text(x, mask)._asdict(), "token_features", "attention_mask")


def temos_motion_reference(model: Temos) -> Reference:
    """Distribution of raw features."""
    return _reference(lambda x, mask: model.encode_motion(x, mask)._asdict(), "motion", "mask")


def temos_decoder_reference(model: Temos) -> Reference:
    """Raw features of a latent."""
    return _reference(lambda z, mask: {"motion": model.decode(z, mask)}, "latent", "mask")


def denoiser_reference(model: LatentDenoiser) -> Reference:
    """Clean latents, guided, normalised and raw; the text is one token, its latent."""

    def guided(latent: Tensor, timestep: Tensor, text: Tensor, guidance: Tensor) -> dict[str, Tensor]:
        shown = torch.ones(len(text), 1, dtype=torch.int64)
        clean, raw = model.guided(latent, timestep, text[:, None], shown, guidance)
        return {"clean": clean, "latent_out": raw}

    return _reference(guided, *(tensor.name for tensor in LATENT_DENOISER.inputs))


def motion_denoiser_reference(model: MotionDenoiser) -> Reference:
    """Clean motions, guided, normalised and raw."""

    def guided(noisy: Tensor, level: Tensor, *told: Tensor) -> dict[str, Tensor]:
        mask, tokens, words, slots, numbers, known, held, holding, guidance = told
        condition = Condition(mask, tokens, words.bool(), slots, numbers, known, held, holding)
        clean = model.guided(noisy, level, condition, guidance)
        return {"clean": clean, "motion": model.denormalise(clean)}

    return _reference(guided, *(tensor.name for tensor in MOTION_DENOISER.inputs))


def _encoded(distribution: Distribution) -> dict[str, Tensor]:
    mu = distribution.mu
    return {"embedding": torch.nn.functional.normalize(mu, dim=-1), "latent": mu}


def _reference(run: Callable[..., dict[str, Tensor]], *inputs: str) -> Reference:
    @torch.no_grad()
    def reference(feeds: Arrays) -> dict[str, np.ndarray[Any, Any]]:
        outputs = run(*(torch.from_numpy(np.ascontiguousarray(feeds[name])) for name in inputs))
        return {name: value.numpy() for name, value in outputs.items()}

    return reference
