"""The one interface that is evaluated: the exported models, or a torch checkpoint."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np
import torch

from motionrt.models import SentenceEncoder
from motionrt.motion.skeleton import FloatArray
from motionrt_training.checkpoint import load_state, trained_model
from motionrt_training.networks.tmr import TMR


class Embedder(Protocol):
    """Anything that puts texts and motions into one space, as unit vectors ``(N, d)``."""

    def embed_text(self, texts: Sequence[str]) -> FloatArray:
        """Unit embeddings ``(N, 256)`` of texts."""

    def embed_motion(self, features: Sequence[FloatArray]) -> FloatArray:
        """Unit embeddings ``(N, 256)`` of ``guo263`` features at 20 fps."""


class TorchEmbedder:
    """A TMR module in evaluation mode, fed with the token features of the shipped sentence encoder."""

    def __init__(self, model: TMR, sentences: SentenceEncoder) -> None:
        self._model = model.eval()
        self._sentences = sentences

    @torch.inference_mode()
    def embed_text(self, texts: Sequence[str]) -> FloatArray:
        """Unit text embeddings ``(N, d)``, one text at a time."""
        rows = [torch.from_numpy(self._sentences.encode(text).token_features) for text in texts]  # (1, T, 384) each
        return _stacked([self._model.encode_text(row, torch.ones(row.shape[:2], dtype=torch.bool)).mu for row in rows])

    @torch.inference_mode()
    def embed_motion(self, features: Sequence[FloatArray]) -> FloatArray:
        """Unit motion embeddings ``(N, d)`` of raw ``guo263`` features."""
        rows = [torch.from_numpy(np.ascontiguousarray(x))[None] for x in features]
        return _stacked([self._model.encode_motion(x, torch.ones(x.shape[:2], dtype=torch.bool)).mu for x in rows])


def load_torch(checkpoint: str | Path, sentences: SentenceEncoder) -> tuple[TorchEmbedder, int]:
    """The averaged weights of a training's checkpoint (``last.pt`` or ``best.pt``), and the steps that it took."""
    state = load_state(checkpoint)
    return TorchEmbedder(trained_model(state, TMR), sentences), int(state["step"])


def _stacked(rows: list[torch.Tensor]) -> FloatArray:
    return np.asarray(torch.nn.functional.normalize(torch.cat(rows), dim=-1).numpy(), dtype=np.float32)
