"""Inputs for validation and calibration: real sentences, and the motions that the model makes of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import torch

from motionrt_export.calibration import SENTENCES
from motionrt_export.specs import GraphSpec, TensorSpec
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR

Array = np.ndarray[Any, Any]
Feeds = dict[str, Array]


class Examples(Protocol):
    """Makes inputs of any size, all of the given length."""

    def __call__(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of ``batch`` rows of that length, the same for the same seed."""


def random_examples(spec: GraphSpec) -> Examples:
    """Numbers from a normal distribution, the upper half of the whole numbers there are: for untrained networks."""

    def make(batch: int, length: int, seed: int) -> Feeds:
        random = np.random.default_rng(seed)
        sizes = spec.sizes(batch, length)
        return {tensor.name: _random(random, tensor, tensor.resolved(sizes)) for tensor in spec.inputs}

    return make


def _random(random: np.random.Generator, tensor: TensorSpec, shape: tuple[int, ...]) -> Array:
    if tensor.dtype == "bool":
        return np.ones(shape, dtype=bool)
    if tensor.dtype == "int64":
        return random.integers(tensor.below // 2, tensor.below, shape)
    return random.standard_normal(shape).astype(np.float32)


class Sentences:
    """Token ids of sentences, strung together to the length wanted; one token is the opening marker."""

    def __init__(self, encode: Callable[[str], list[int]]) -> None:
        self._ids = [encode(sentence) for sentence in SENTENCES]

    def __call__(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of ``batch`` rows of that length, the same for the same seed."""
        random = np.random.default_rng(seed)
        rows = np.stack([self._row(random, length) for _ in range(batch)])
        return {"input_ids": rows, "attention_mask": np.ones_like(rows)}

    def _row(self, random: np.random.Generator, length: int) -> Array:
        start, end = self._ids[0][0], self._ids[0][-1]
        row = [start]
        while len(row) < length - 1:
            row += self._ids[random.integers(len(self._ids))][1:-1]
        return np.array([*row[: length - 1], end][-length:] if length > 1 else [start], dtype=np.int64)


class Motions:
    """What the networks make of the sentences: token features, latents, and motions decoded from them."""

    def __init__(self, sentences: Sentences, backbone: MiniLM, model: TMR | Temos) -> None:
        self._sentences, self._backbone, self._model = sentences, backbone, model

    def text(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of the text encoder."""
        feeds = self._sentences(batch, length, seed)
        return {"token_features": self._features(feeds), "attention_mask": feeds["attention_mask"]}

    def decoder(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of the decoder."""
        return {"latent": self._latents(batch, seed), "mask": np.ones((batch, length), dtype=bool)}

    def motion(self, batch: int, length: int, seed: int) -> Feeds:
        """Inputs of the motion encoder."""
        mask = torch.ones(batch, length, dtype=torch.bool)
        with torch.no_grad():
            motion = self._model.decode(torch.from_numpy(self._latents(batch, seed)), mask)
        return {"motion": motion.numpy(), "mask": mask.numpy()}

    @torch.no_grad()
    def _features(self, feeds: Feeds) -> Array:
        ids, mask = torch.from_numpy(feeds["input_ids"]), torch.from_numpy(feeds["attention_mask"])
        features: Array = self._backbone(ids, mask).numpy()
        return features

    def _latents(self, batch: int, seed: int) -> Array:
        return self.latents(self.text(batch, 16, seed))

    @torch.no_grad()
    def latents(self, feeds: Feeds) -> Array:
        """Latents (B, 256) that the text encoder gives its inputs."""
        features, mask = torch.from_numpy(feeds["token_features"]), torch.from_numpy(feeds["attention_mask"])
        latents: Array = self._model.encode_text(features, mask).mu.numpy()
        return latents
