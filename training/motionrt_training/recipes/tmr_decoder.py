"""Train the motion decoder of a finished TMR further, from text alone, both encoders frozen.

    python -m motionrt_training.recipes.tmr_decoder --from runs/tmr/best.pt --corpus runs/cmu.npz --out runs/decoder

A text does not say at which foot a walk starts, so crops that start anywhere teach the decoder the average of all phases:
a figure that glides. Here every clip starts at its own beginning or, where its feet swing, at the moment when the left
toe is farthest ahead. Retrieval does not change: the encoders stay as they are. The result is released like any other
checkpoint of TMR (``python -m motionrt_training.recipes.tmr --release``).
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from motionrt.motion.features import guo263
from motionrt.motion.skeleton import SMPL24
from motionrt_training import losses as L
from motionrt_training.backbones import open_backbone
from motionrt_training.batches import padded
from motionrt_training.checkpoint import load_state
from motionrt_training.networks.tmr import TMR
from motionrt_training.options import add_options, from_namespace, option
from motionrt_training.packed import PackedCorpus, load_packed
from motionrt_training.text_cache import TextFeatures, cached_features
from motionrt_training.trainer import Schedule, Trainer

STRIDE = 0.3  # metres between the toes' extremes, from which on the feet swing
_LEFT, _RIGHT = (guo263.POSITIONS.start + 3 * (SMPL24.index(name) - 1) + 2 for name in ("left_foot", "right_foot"))


@dataclass(frozen=True)
class DecoderSettings:
    """Data and loss of the second stage."""

    batch: int = option(32, "clips per batch")
    most_frames: int = option(120, "longest clip, frames at 20 fps")
    search_frames: int = option(25, "frames in which the start of a gait is sought")
    velocity_weight: float = option(1.0, "weight of the difference between neighbouring frames")
    latent_noise: float = option(0.03, "standard deviation of the noise on the latents")


@dataclass(frozen=True)
class Example:
    """One clip, or its mirror image, from its starting phase on, with the latents of its texts."""

    motion: NDArray[np.float32]  # (F, 263) raw
    latents: Tensor  # (texts, d)


class DecoderTask:
    """The task of `Trainer`: reconstruct motions from the means of their texts' latents."""

    def __init__(self, model: TMR, corpus: PackedCorpus, texts: TextFeatures, settings: DecoderSettings, seed: int):
        self.model, self.settings, self.seed = model, settings, seed
        for part in (model.text_encoder, model.motion_encoder):
            part.requires_grad_(False)
        latents = dict(zip(corpus.texts(), text_latents(model, texts), strict=True))
        self.examples = examples(corpus, "train", latents, settings)
        self.held_out = examples(corpus, "val", latents, settings)

    def batch(self, step: int) -> dict[str, Tensor]:
        """Draw latent (B, d), motion (B, F, 263) raw with mask (B, F)."""
        rng = np.random.default_rng((self.seed, step))
        chosen = [self.examples[i] for i in rng.choice(len(self.examples), self.settings.batch, replace=False)]
        rows = [example.latents[int(rng.integers(len(example.latents)))] for example in chosen]
        motion, mask = padded([example.motion for example in chosen])
        return {"latent": torch.stack(rows), "motion": motion, "mask": mask}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """Smooth-L1 of the frames and of their differences."""
        motion, mask = self.model.normalise(batch["motion"]), batch["mask"]
        latent = batch["latent"] + self.settings.latent_noise * torch.randn_like(batch["latent"])
        decoded = cast("TMR", model).motion_decoder(latent, mask)
        frames = L.reconstruction(decoded, motion, mask).mean()
        steps = L.reconstruction(decoded.diff(dim=1), motion.diff(dim=1), mask[:, 1:]).mean()
        return {"loss": frames + self.settings.velocity_weight * steps, "reconstruction": frames, "steps": steps}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Reconstruction of held-out clips, to watch, and of training clips, whose negative is the `score`."""
        held_out, known = (self._error(cast("TMR", model), part) for part in (self.held_out, self.examples[:64]))
        return {"held_out": held_out, "known": known, "score": -known}

    def _error(self, model: TMR, part: Sequence[Example]) -> float:
        motion, mask = padded([example.motion for example in part])
        decoded = model.motion_decoder(torch.stack([example.latents[1] for example in part]), mask)
        return float(L.reconstruction(decoded, self.model.normalise(motion), mask).mean())


@torch.no_grad()
def text_latents(model: TMR, texts: TextFeatures) -> list[Tensor]:
    """Mean latent (d,) of every text, one by one."""
    rows = [torch.from_numpy(texts.of(index).astype(np.float32))[None] for index in range(len(texts.start))]
    return [model.eval().encode_text(row, torch.ones(row.shape[:2], dtype=torch.bool)).mu[0] for row in rows]


def examples(
    corpus: PackedCorpus, split: str, latents: dict[str, Tensor], settings: DecoderSettings
) -> list[Example]:
    """Every clip of a split and its mirror image."""
    found = []
    for clip in corpus.split(split):
        for mirror, texts in ((False, clip.texts), (True, clip.texts_mirror)):
            motion = corpus.motion(clip, mirror=mirror).astype(np.float32)
            start = first_stride(motion[: settings.search_frames])
            rows = torch.stack([latents[text] for text in texts])
            found.append(Example(motion[start : start + settings.most_frames], rows))
    return found


def first_stride(motion: NDArray[np.float32]) -> int:
    """The frame of (F, 263) in which the left toe is farthest ahead of the right; 0 where the feet do not swing."""
    ahead = motion[:, _LEFT] - motion[:, _RIGHT]
    return int(np.argmax(ahead)) if np.ptp(ahead) > STRIDE else 0


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(DecoderSettings, args)
    first = load_state(args.start)
    model = TMR(**first["notes"]["network"])
    model.load_state_dict(first["model"])
    corpus = load_packed(args.corpus)
    backbone = open_backbone(args.backbone, args.backbone_path)
    texts = cached_features(corpus.texts(), backbone, Path(args.corpus).parent)
    task = DecoderTask(model, corpus, texts, settings, schedule.seed)
    notes = {**first["notes"], "decoder": dataclasses.asdict(settings), "first_stage": first["measures"]}
    return Trainer(task, schedule, args.out, notes).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = argparse.ArgumentParser(description="Train the decoder of a finished TMR further.")
    result.add_argument("--from", dest="start", type=Path, required=True, help="best.pt of the first stage")
    result.add_argument("--corpus", type=Path, required=True, help="packed corpus (.npz)")
    result.add_argument("--out", type=Path, required=True, help="folder of the run")
    result.add_argument("--backbone", default="minilm", choices=("onnx", "minilm", "hf"), help="text backbone")
    result.add_argument("--backbone-path", type=Path, help="file (onnx) or folder (hf) of the backbone")
    add_options(result, Schedule)
    add_options(result, DecoderSettings)
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
