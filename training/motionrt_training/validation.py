"""Retrieval of a split with the torch networks, as training watches it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import torch
import torch.nn.functional as F
from numpy.typing import NDArray
from torch import Tensor

from motionrt.metrics import retrieval
from motionrt_training.batches import padded
from motionrt_training.contrasts import contrast_scores
from motionrt_training.losses import info_nce
from motionrt_training.networks.tmr import TMR
from motionrt_training.packed import PackedCorpus
from motionrt_training.text_cache import TextFeatures

CHUNK = 64


def split_measures(
    model: TMR,
    corpus: PackedCorpus,
    texts: TextFeatures,
    index: Mapping[str, int],
    split: str,
    most_frames: int = 200,
) -> dict[str, float]:
    """R@1, 3, 10 and MedR both ways (protocol (a), mean over the captions) and `score`, their mean recall.

    {} when the split has fewer than two clips.
    """
    clips = corpus.split(split)
    if len(clips) < 2:
        return {}
    motion = embed_motions(model, [corpus.motion(clip)[:most_frames].astype(np.float32) for clip in clips])
    rows = []
    for caption in range(min(len(clip.texts) for clip in clips)):
        numbers = [index[clip.texts[caption]] for clip in clips]
        rows.append(_measures(embed_texts(model, [texts.of(number) for number in numbers]), motion))
    measures = {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}
    measures["score"] = float(np.mean([value for name, value in measures.items() if "_R" in name]))
    return measures


def contrast_measures(
    model: TMR,
    corpus: PackedCorpus,
    texts: TextFeatures,
    index: Mapping[str, int],
    split: str,
    most_frames: int = 200,
) -> dict[str, float]:
    """Side test and path test of a split, see `contrast_scores`; {} where no caption counts."""
    clips = corpus.split(split)
    return contrast_scores(
        [clip.texts for clip in clips],
        [corpus.motion(clip)[:most_frames].astype(np.float32) for clip in clips],
        lambda said: embed_texts(model, [texts.of(index[text]) for text in said]).numpy(),
        lambda motions: embed_motions(model, motions).numpy(),
        corpus.mirror,
    )


def embed_motions(model: TMR, motions: Sequence[NDArray[np.floating]]) -> Tensor:
    """Raw guo263 clips (F_i, 263) -> (N, d) unit norm, on the CPU."""
    return _embed(model.encode_motion, motions, model.motion_mean.device)


def embed_texts(model: TMR, tokens: Sequence[NDArray[np.floating]]) -> Tensor:
    """Token features (T_i, 384) -> (N, d) unit norm, on the CPU."""
    return _embed(model.encode_text, tokens, model.motion_mean.device)


@torch.no_grad()
def _embed(encode: object, parts: Sequence[NDArray[np.floating]], device: torch.device) -> Tensor:
    order = np.argsort([len(part) for part in parts], kind="stable")
    rows: list[Tensor] = []
    for first in range(0, len(order), CHUNK):
        values, mask = padded([parts[i] for i in order[first : first + CHUNK]])
        latent = encode(values.to(device), mask.to(device)).mu  # type: ignore[operator]
        rows.append(F.normalize(latent.float(), dim=-1).cpu())
    return torch.cat(rows)[torch.from_numpy(np.argsort(order))]


def _measures(text: Tensor, motion: Tensor) -> dict[str, float]:
    result = retrieval((text @ motion.T).numpy())
    measures: dict[str, float] = {}
    for name, scores in (("t2m", result.text_to_motion), ("m2t", result.motion_to_text)):
        measures |= {f"{name}_R{k}": scores.recall[k] for k in (1, 3, 10)}
        measures[f"{name}_MedR"] = scores.median_rank
    measures["nce"] = float(info_nce(text, motion))
    return measures
