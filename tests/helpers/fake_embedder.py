"""A stand-in for the text and motion encoders: instant, deterministic, and with an opinion about speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

WIDTH = 256


class FakeEmbedder:
    """Embeds a motion by a fixed random projection of its mean features, a text by a vector drawn from its
    letters.
    """

    def __init__(self, fingerprint: str = "f" * 64, name: str = "fake") -> None:
        self.fingerprint, self.name, self.calls = fingerprint, name, 0
        self._projection = np.random.default_rng(7).normal(size=(263, WIDTH)).astype(np.float32)

    def prepare(self) -> None:
        """There is nothing to open."""

    def embed_motion(self, features: Sequence[np.ndarray]) -> np.ndarray:
        self.calls += len(features)
        return _unit(np.stack([window.mean(axis=0) @ self._projection for window in features]))

    def embed_text(self, texts: Sequence[str]) -> np.ndarray:
        seeds = [sum(ord(letter) * 31**i for i, letter in enumerate(text)) % 2**32 for text in texts]
        return _unit(np.stack([np.random.default_rng(seed).normal(size=WIDTH) for seed in seeds]))


def open_fake() -> FakeEmbedder:
    return FakeEmbedder()


def open_other() -> FakeEmbedder:
    return FakeEmbedder("0" * 64, "another")


def _unit(vectors: np.ndarray) -> np.ndarray:
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)
