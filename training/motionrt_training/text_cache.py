"""Token features and sentence embeddings of a frozen backbone, computed once per text and kept on disk."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt_training.backbones import Backbone, Encoded

CHUNK = 64  # texts that a backbone reads together


@dataclass(frozen=True)
class TextFeatures:
    """What a backbone says of N texts, packed."""

    tokens: NDArray[np.float16]  # (sum of T, width), the texts one after another
    start: NDArray[np.int64]  # (N,)
    length: NDArray[np.int64]  # (N,) tokens of each text
    sentences: NDArray[np.float16]  # (N, width) unit norm

    def of(self, index: int) -> NDArray[np.float16]:
        """Token features (T, width) of one text."""
        first = int(self.start[index])
        return self.tokens[first : first + int(self.length[index])]


def cached_features(texts: Sequence[str], backbone: Backbone, folder: str | Path) -> TextFeatures:
    """Features of `texts`, from `folder` when the same texts met the same backbone before."""
    path = Path(folder) / f"text-{_key(texts, backbone.fingerprint)}.npz"
    if path.exists():
        with np.load(path) as saved:
            return TextFeatures(saved["tokens"], saved["start"], saved["length"], saved["sentences"])
    features = compute_features(texts, backbone)
    _save(features, path)
    return features


def compute_features(texts: Sequence[str], backbone: Backbone) -> TextFeatures:
    """Run the backbone over the texts: many at once where it can, else one by one, as when they are searched."""
    with tqdm(total=len(texts), desc="texts", unit="text", disable=len(texts) < 50) as bar:
        encoded = _encoded(texts, backbone, bar)
    length = np.array([len(tokens) for tokens, _ in encoded], dtype=np.int64)
    return TextFeatures(
        np.concatenate([tokens for tokens, _ in encoded]).astype(np.float16),
        np.cumsum(length) - length,
        length,
        np.stack([sentence for _, sentence in encoded]).astype(np.float16),
    )


def _encoded(texts: Sequence[str], backbone: Backbone, bar: Any) -> list[Encoded]:
    found: dict[int, Encoded] = {}
    together = getattr(backbone, "encode_together", None)
    size = CHUNK if together else 1
    order = np.argsort([len(text) for text in texts], kind="stable").tolist()  # alike in length: little padding
    for first in range(0, len(order), size):
        chosen = order[first : first + size]
        some = [texts[i] for i in chosen]
        found |= dict(zip(chosen, together(some) if together else map(backbone.encode, some), strict=True))
        bar.update(len(chosen))
    return [found[i] for i in range(len(texts))]


def _key(texts: Sequence[str], fingerprint: str) -> str:
    digest = hashlib.sha256(fingerprint.encode("utf-8"))
    for text in texts:
        digest.update(hashlib.sha256(text.encode("utf-8")).digest())
    return digest.hexdigest()[:24]


def _save(features: TextFeatures, path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".part")
    with temporary.open("wb") as file:
        np.savez(
            file,
            tokens=features.tokens,
            start=features.start,
            length=features.length,
            sentences=features.sentences,
        )
    temporary.replace(path)
