"""Latents of a frozen TEMOS for many views of every clip, with what is said of each: computed once, kept on disk."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt_training.batches import padded
from motionrt_training.networks.temos import Temos

Floats = NDArray[np.float32]
View = tuple[Floats, tuple[str, ...]]  # egocentric frames (F, 136) at 30 fps, what is said
CHUNK = 32  # views that are encoded together
BLOCK = 1024  # views that are sorted by length together


@dataclass(frozen=True)
class Latents:
    """Posteriors of N views, and what is said of each (several texts where they are encoded separately)."""

    mu: Floats  # (N, 256)
    logvar: Floats  # (N, 256)
    texts: tuple[tuple[str, ...], ...]

    def __len__(self) -> int:
        return len(self.texts)

    def statistics(self) -> tuple[Floats, Floats]:
        """Mean and standard deviation (256,) of samples of the posteriors, floored."""
        mu = self.mu.astype(np.float64)
        variance = mu.var(axis=0) + np.exp(self.logvar.astype(np.float64)).mean(axis=0)
        return mu.mean(axis=0).astype(np.float32), np.sqrt(np.maximum(variance, 1e-6)).astype(np.float32)

    def sample(self, rows: NDArray[np.int64], rng: np.random.Generator) -> Floats:
        """One latent (B, 256) from the posterior of each row."""
        noise = rng.standard_normal((len(rows), self.mu.shape[1]), dtype=np.float32)
        return np.asarray(self.mu[rows] + np.exp(0.5 * self.logvar[rows]) * noise, np.float32)


def cached_latents(key: Sequence[str], compute: Callable[[], Latents], folder: str | Path) -> Latents:
    """`compute()`, or what it gave for the same `key` before; kept in `folder` as ``latents-....npz``."""
    digest = hashlib.sha256("\0".join(key).encode("utf-8")).hexdigest()[:16]
    path = Path(folder) / f"latents-{digest}.npz"
    if not path.exists():
        latents = compute()
        _save(latents, path)
        return latents
    with np.load(path, allow_pickle=False) as saved:
        texts = tuple(tuple(row) for row in json.loads(str(saved["texts"])))
        return Latents(saved["mu"], saved["logvar"], texts)


def encode_views(temos: Temos, views: Iterable[View]) -> Latents:
    """The motion encoder's posterior of every view, in their order; no more than `BLOCK` of them are held at once.

    Raises:
        ValueError: no views.
    """
    views, parts = iter(views), list[Latents]()
    with tqdm(desc="latents", unit="view") as bar:
        while block := list(islice(views, BLOCK)):
            parts.append(_encoded(temos, block))
            bar.update(len(block))
    if not parts:
        raise ValueError("no views to encode; the corpus has no clip in this split")
    texts = tuple(text for part in parts for text in part.texts)
    return Latents(np.concatenate([part.mu for part in parts]), np.concatenate([part.logvar for part in parts]), texts)


def _encoded(temos: Temos, block: Sequence[View]) -> Latents:
    """Views of like length go through the encoder together."""
    order = np.argsort([len(frames) for frames, _ in block], kind="stable")
    mu, logvar = np.empty((2, len(block), int(temos.config["d"])), np.float32)
    for first in range(0, len(order), CHUNK):
        rows = order[first : first + CHUNK]
        mu[rows], logvar[rows] = _posterior(temos, [block[row][0] for row in rows])
    return Latents(mu, logvar, tuple(texts for _, texts in block))


@torch.no_grad()
def _posterior(temos: Temos, frames: Sequence[Floats]) -> tuple[Floats, Floats]:
    values, mask = padded(frames)
    device = temos.frame_mean.device
    found = temos.eval().motion_encoder(temos.normalise(values.to(device)), mask.to(device))
    return found.mu.cpu().numpy(), found.logvar.cpu().numpy()


def _save(latents: Latents, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".part")
    with temporary.open("wb") as file:
        np.savez(file, mu=latents.mu, logvar=latents.logvar, texts=json.dumps(latents.texts))
    temporary.replace(path)
