"""Make the starter gallery: motions of prompts written for it, by a small autoregressive model trained here.

    python -m motionrt_training.recipes.starter --corpus runs/cmu.npz --out runs/starter --minutes 12
    python -m motionrt_training.recipes.starter --make runs/starter/last.pt --to runtime/motionrt/_assets/starter

A text does not say at which foot a walk starts, so the decoder of TMR, which maps a text to all frames at once, gives
the average of all phases. The model here continues the last frames instead, so that a gait, once begun, goes on. TMR's
decoder gives the first pose; of several roll-outs the one whose embedding is nearest to the prompt's is kept, and none
that leaves the range of human poses or that the motion encoder does not recognise. (The last checkpoint moves more than
the one with the lowest held-out loss.)
"""

from __future__ import annotations

import argparse
import dataclasses
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt import Gallery, Runtime
from motionrt.models import TextMotionModel
from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import motion_features
from motionrt_training.checkpoint import load_state
from motionrt_training.networks.continuation import POSE, Continuation
from motionrt_training.options import add_options, from_namespace, option
from motionrt_training.packed import PackedCorpus, load_packed, statistics
from motionrt_training.trainer import Schedule, Trainer

FARTHEST = 12.0  # standard deviations from the mean that a feature may have
HIGHEST, LOWEST = 2.6, -0.25  # metres
RECOGNISED = 0.5  # least cosine of motion and prompt
PROMPTS = Path(__file__).with_name("starter_prompts.txt")


@dataclass(frozen=True)
class StarterSettings:
    """Network, data and loss."""

    history: int = option(8, "frames that the network sees")
    ahead: int = option(4, "frames that it predicts")
    width: int = option(1024, "width of the network")
    blocks: int = option(2, "residual blocks")
    batch: int = option(512, "windows per batch")
    unroll: int = option(3, "predictions in a row that are trained")
    unroll_after: int = option(600, "steps before --unroll begins")
    noise: float = option(0.16, "largest noise on the history, standard deviations")


@dataclass(frozen=True)
class Windows:
    """Every window of a split, mirror images included; ``frames`` are normalised."""

    frames: Tensor  # (sum of F, 193)
    first: Tensor  # (W,) first frame of each window
    clip: Tensor  # (W,) its clip
    texts: list[list[str]]  # of each clip

    def draw(self, rng: np.random.Generator, count: int, length: int) -> tuple[Tensor, list[str]]:
        """``count`` random windows (count, length, 193) and a text of each."""
        pick = torch.from_numpy(rng.integers(len(self.first), size=count))
        texts = [self.texts[clip] for clip in self.clip[pick].tolist()]
        chosen = [options[int(rng.integers(len(options)))] for options in texts]
        return self.frames[self.first[pick, None] + torch.arange(length)], chosen


class StarterTask:
    """The task of `Trainer`: continue windows of the corpus under the latents of their texts."""

    def __init__(self, corpus: PackedCorpus, model: TextMotionModel, settings: StarterSettings, seed: int) -> None:
        self.settings, self.seed = settings, seed
        self.length = settings.history + settings.ahead * settings.unroll
        torch.manual_seed(seed)
        self.model: nn.Module = Continuation(settings.history, settings.ahead, settings.width, settings.blocks)
        mean, std = (torch.from_numpy(part[:POSE]) for part in statistics(corpus))
        cast("Tensor", self.model.mean).copy_(mean)
        cast("Tensor", self.model.std).copy_(std)
        self.train, self.val = (windows(corpus, split, mean, std, self.length) for split in ("train", "val"))
        texts = corpus.texts()
        self.latents = dict(zip(texts, torch.from_numpy(model.text_latents(texts)), strict=True))

    def batch(self, step: int) -> dict[str, Tensor]:
        """Draw window (B, length, 193), latent (B, d) and how many predictions to chain."""
        frames, texts = self.train.draw(np.random.default_rng((self.seed, step)), self.settings.batch, self.length)
        chain = self.settings.unroll if step >= self.settings.unroll_after else 1
        return {"window": frames, "latent": self._latents(texts), "chain": torch.tensor(chain)}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """Smooth-L1 of a chain of predictions from a noisy history."""
        window = batch["window"]
        history = window[:, : self.settings.history]
        scale = self.settings.noise * torch.rand(len(window), 1, 1, device=window.device)
        noisy = history + scale * torch.randn_like(history)
        return {"loss": self._chain(model, window, noisy, batch["latent"], int(batch["chain"]))}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """The loss of held-out windows; its negative is the score."""
        frames, texts = self.val.draw(np.random.default_rng(0), 512, self.length)
        history = frames[:, : self.settings.history]
        loss = float(self._chain(model, frames, history, self._latents(texts), self.settings.unroll))
        return {"held_out": loss, "score": -loss}

    def _chain(self, model: nn.Module, window: Tensor, history: Tensor, latent: Tensor, chain: int) -> Tensor:
        first, ahead, loss = self.settings.history, self.settings.ahead, torch.zeros(())
        for index in range(chain):
            predicted = model(history, latent).float()
            target = window[:, first + index * ahead : first + (index + 1) * ahead]
            loss = loss + F.smooth_l1_loss(predicted, target, beta=0.2) / chain
            history = torch.cat((history, predicted), dim=1)[:, -first:]
        return loss

    def _latents(self, texts: Sequence[str]) -> Tensor:
        return torch.stack([self.latents[text] for text in texts])


def windows(corpus: PackedCorpus, split: str, mean: Tensor, std: Tensor, length: int) -> Windows:
    """Every window of ``length`` frames of the clips of ``split`` and of their mirror images."""
    frames, first, clips, texts, total = [], [], [], [], 0
    for clip in corpus.split(split):
        for mirror, captions in ((False, clip.texts), (True, clip.texts_mirror)):
            part = torch.from_numpy(corpus.motion(clip, mirror=mirror)[:, :POSE].astype(np.float32))
            starts = torch.arange(max(0, len(part) - length + 1)) + total
            first.append(starts)
            clips.append(torch.full_like(starts, len(texts)))
            texts.append(list(captions))
            frames.append((part - mean) / std)
            total += len(part)
    return Windows(torch.cat(frames), torch.cat(first), torch.cat(clips), texts)


def make(checkpoint: Path, folder: Path, *, candidates: int = 32, warm_up: int = 20) -> Gallery:
    """Roll the prompts out, keep the best of each, and write the gallery with its motions to ``folder``."""
    state = load_state(checkpoint)
    network = Continuation(**state["notes"]["network"]).eval()
    network.load_state_dict(state["model"])
    model = Runtime(text_tower="full").model
    motions, texts = [], []
    for index, (seconds, text) in enumerate(read_prompts(PROMPTS)):
        made = roll_outs(network, model, text, round(seconds * guo263.FPS) + warm_up, candidates, index)
        best = best_of([motion[warm_up:].canonical() for motion in made], model, text)
        if best is not None:
            motions.append(best)
            texts.append(text)
    ids = [re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-") for text in texts]
    return Gallery.from_motions(motions, ids, model, texts=texts).save(folder)


def roll_outs(
    network: Continuation, model: TextMotionModel, text: str, frames: int, candidates: int, seed: int
) -> list[Motion]:
    """Roll-outs that begin at TMR's pose for the text with noise, those that stay in the range of human poses."""
    latent = model.text_latents([text])
    pose = torch.from_numpy(model.decode(latent, network.history)[0, :, :POSE])
    noise = torch.randn((candidates, network.history, POSE), generator=torch.Generator().manual_seed(seed))
    made = network.roll_out(pose + 0.3 * noise * network.std, torch.from_numpy(latent).expand(candidates, -1), frames)
    inside = (((made - network.mean) / network.std).abs() < FARTHEST).flatten(1).all(1)
    return [motion for motion in map(_motion, made[inside].numpy()) if _between_floor_and_ceiling(motion)]


def best_of(motions: Sequence[Motion], model: TextMotionModel, text: str) -> Motion | None:
    """The motion that fits the text best, if any fits it."""
    if not motions:
        return None
    fits = model.embed_motion([motion_features(motion) for motion in motions]) @ model.embed_text([text])[0]
    return motions[int(np.argmax(fits))] if fits.max() >= RECOGNISED else None


def _between_floor_and_ceiling(motion: Motion) -> bool:
    heights = motion.positions()[..., 1]
    return bool(heights.min() > LOWEST and heights.max() < HIGHEST)


def read_prompts(path: Path) -> Iterator[tuple[float, str]]:
    """(seconds, prompt) of every line that is neither empty nor a comment."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            seconds, _, text = line.partition("|")
            yield float(seconds), text.strip()


def _motion(features: FloatArray) -> Motion:
    """guo263 from its first 193 columns; velocities and contacts are not needed to decode."""
    return guo263.decode(np.pad(features, ((0, 0), (0, guo263.WIDTH - POSE))))


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into ``args.out``; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(StarterSettings, args)
    task = StarterTask(load_packed(args.corpus), Runtime(text_tower="full").model, settings, schedule.seed)
    notes = {**dataclasses.asdict(settings), "network": cast("Continuation", task.model).config}
    return Trainer(task, schedule, args.out, notes).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = argparse.ArgumentParser(description="Train the maker of the starter gallery, or make the gallery.")
    result.add_argument("--corpus", type=Path, help="packed corpus (.npz)")
    result.add_argument("--out", type=Path, help="folder of the run")
    result.add_argument("--make", type=Path, help="checkpoint to make the gallery with; nothing is trained")
    result.add_argument("--to", type=Path, default=Path("runtime/motionrt/_assets/starter"), help="the gallery")
    add_options(result, Schedule)
    add_options(result, StarterSettings)
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    reader = parser()
    args = reader.parse_args(arguments)
    if args.make:
        print(make(args.make, args.to))
    elif args.corpus and args.out:
        train(args)
    else:
        reader.error("give --corpus and --out to train, or --make")


if __name__ == "__main__":
    main()
