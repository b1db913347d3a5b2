r"""Train the denoiser of latent diffusion on the latents of a trained TEMOS (MLD, Chen et al. 2023).

    python -m motionrt_training.recipes.latent_diffusion --corpus runs/recordings.npz \
        --captions-file ../shared/data/mocap/cmu/captions.jsonl --temos runs/temos/best.pt \
        --out runs/latent_denoiser --minutes 15 --lr 5e-4 --ema 0.995

TEMOS is frozen. A text is told to the denoiser by the mean of its latent, one token: the text encoder of TEMOS has read
the captions for hours already. The posteriors of many views of the clips (crops, speeds, mirror images, synthetic
pairs, drawn as for TEMOS itself) are computed once and kept in ``--out``. Every step draws latents from them. The loss
is the squared error of the clean latent times min(1 + SNR, a cap): that of velocity prediction, which counts all time
steps alike, except where so little noise is left that only details are to be learnt.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from motionrt.synthesis.sampling import GUIDANCE, STEPS
from motionrt_training.backbones import open_backbone
from motionrt_training.batches import padded
from motionrt_training.checkpoint import load_any
from motionrt_training.corpora.actions import ActionClip, read_actions
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.data_record import data_of
from motionrt_training.latent_cache import Floats, Latents, cached_latents, encode_views
from motionrt_training.networks.latent_denoiser import LatentDenoiser, draw_latents
from motionrt_training.networks.temos import Temos
from motionrt_training.options import from_namespace, option, recipe_parser
from motionrt_training.temos_data import ActionData, Example, Examples, SpokenTexts
from motionrt_training.temos_task import held_out_examples
from motionrt_training.trainer import Schedule, Trainer

Ints = NDArray[np.int64]
Speak = Callable[[tuple[str, ...]], NDArray[np.floating]]  # texts of an example -> its tokens (T, width)
BUCKET = 8  # batches that are sorted by length of text together
TIMES = (100, 300, 500, 700, 850, 999)  # time steps that are validated


@dataclass(frozen=True)
class DenoiserSettings:
    """Network, data and loss."""

    d: int = option(256, "width")
    layers: int = option(5, "layers, an odd number (MLD: 9)")
    heads: int = option(4, "attention heads")
    ff: int = option(1024, "feed-forward width")
    dropout: float = option(0.1, "dropout rate")
    batch: int = option(256, "latents per batch")
    views: int = option(20000, "views of the clips whose latents are computed")
    no_text: float = option(0.1, "part of the latents that are trained without text, for guidance")
    token_dropout: float = option(0.0, "part of the text tokens hidden in training")
    text_noise: float = option(0.1, "noise on the text's latent in training")
    snr_cap: float = option(5.0, "largest weight of a time step, as min(1 + SNR, cap)")
    draw_steps: int = option(STEPS, "DDIM steps of the validation")
    guidance: float = option(GUIDANCE, "guidance of the validation")


class LatentDiffusionTask:
    """The task of `Trainer`, for training and held-out latents; `speak` gives the features of their texts."""

    def __init__(self, train: Latents, held_out: Latents, speak: Speak, settings: DenoiserSettings, seed: int) -> None:
        self.train, self.held_out, self.speak, self.settings, self.seed = train, held_out, speak, settings, seed
        self.lengths = np.array([len(speak(texts)) for texts in train.texts])
        torch.manual_seed(seed)
        s = settings
        size = speak(train.texts[0]).shape[1], train.mu.shape[1], s.d, s.layers, s.heads, s.ff, s.dropout
        self.model: LatentDenoiser = LatentDenoiser(*size)
        mean, std = train.statistics()
        self.model.latent_mean.copy_(torch.from_numpy(mean))
        self.model.latent_std.copy_(torch.from_numpy(std))

    def batch(self, step: int) -> dict[str, Tensor]:
        """Raw latents, noise (B, 256), time steps (B,), tokens (B, T, width) with the mask of what is shown (B, T)."""
        rng, rows = np.random.default_rng((self.seed, step, 1)), self._rows(step)
        tokens, mask = self._spoken([self.train.texts[row] for row in rows])
        blur = self.settings.text_noise * rng.standard_normal(tokens.shape, dtype=np.float32)
        even = (np.arange(len(rows)) + rng.random(len(rows))) / len(rows)  # all times alike in every batch
        noise = rng.standard_normal((len(rows), self.train.mu.shape[1]), dtype=np.float32)
        return {
            "latent": torch.from_numpy(self.train.sample(rows, rng)),
            "noise": torch.from_numpy(noise),
            "timestep": torch.from_numpy(rng.permutation((1000 * even).astype(np.int64))),
            "tokens": tokens + torch.from_numpy(blur),
            "mask": mask & torch.from_numpy(self._shown(rng, mask.shape)),
        }

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """Weighted squared error of the clean latent, and the plain one."""
        net, time = self.model, batch["timestep"]
        clean = net.normalise(batch["latent"])
        found = model(net.noised(clean, time, batch["noise"]), time, batch["tokens"], batch["mask"])
        error = (found - clean).square().mean(1)  # (B,)
        return {"loss": (self._weight(time) * error).mean(), "plain": error.mean()}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Errors of held-out latents at several times; whether latents drawn from their texts come near them.

        ``own``: how often the held-out latent nearest to a drawn one is its own; ``nearer``: which part of the others
        is nearer than it (chance 0.5); ``spread``: standard deviation of the drawn latents, 1 for the training data.
        """
        net = cast("LatentDenoiser", model)
        device = net.latent_mean.device
        clean = net.normalise(torch.from_numpy(self.held_out.mu).to(device))
        tokens, mask = (part.to(device) for part in self._spoken(self.held_out.texts))
        noise = torch.randn(clean.shape, generator=torch.Generator().manual_seed(0)).to(device)
        errors, score = {}, 0.0
        for step in TIMES:
            time = torch.full((len(clean),), step, device=device)
            error = (net(net.noised(clean, time, noise), time, tokens, mask) - clean).square().mean()
            errors[f"error_{step}"] = float(error)
            score -= float(self._weight(time)[0] * error) / len(TIMES)
        s = self.settings
        drawn = net.normalise(draw_latents(net, tokens, mask, noise, s.draw_steps, s.guidance))
        return {**errors, **nearness(drawn, clean), "spread": float(drawn.std(0).mean()), "score": score}

    def _rows(self, step: int) -> Ints:
        """The rows of a step: random in every `BUCKET` batches, among which they are sorted by length of text."""
        block, index = divmod(step, BUCKET)
        rng, size = np.random.default_rng((self.seed, block)), self.settings.batch
        rows = rng.choice(len(self.train), size * BUCKET, replace=len(self.train) < size * BUCKET)
        batches = rows[np.argsort(self.lengths[rows], kind="stable")].reshape(BUCKET, size)
        return np.asarray(batches[rng.permutation(BUCKET)[index]])

    def _shown(self, rng: np.random.Generator, shape: Sequence[int]) -> NDArray[np.bool_]:
        """Which tokens (B, T) of the texts may be seen: some texts not at all."""
        s = self.settings
        return (rng.random(shape) >= s.token_dropout) & (rng.random((shape[0], 1)) >= s.no_text)

    def _spoken(self, texts: Sequence[tuple[str, ...]]) -> tuple[Tensor, Tensor]:
        return padded([self.speak(text) for text in texts])

    def _weight(self, time: Tensor) -> Tensor:
        """min(1 + SNR, cap) of time steps (B,): 1 + SNR is 1 / (1 - a_t)."""
        return (1.0 / self.model.angle[time].sin().square()).clamp(max=self.settings.snr_cap)


def nearness(drawn: Tensor, truth: Tensor) -> dict[str, float]:
    """Of latents (N, D) drawn for each of N true ones: is the own one nearest, and how many others are nearer."""
    distance = torch.cdist(drawn, truth)  # (N, N)
    own = distance.diagonal()[:, None] - 1e-3  # captions of one clip share their latent
    nearer = (distance < own).float()
    return {"own": float((nearer.sum(1) == 0).float().mean()), "nearer": float(nearer.mean())}


def training_latents(temos: Temos, clips: Sequence[ActionClip], data: ActionData, views: int, seed: int) -> Latents:
    """Posteriors of random views of the training clips, drawn as TEMOS draws its examples."""
    examples = Examples([clip for clip in clips if clip.split == "train"], data)
    rng = np.random.default_rng(seed)
    return encode_views(temos, (_view(examples.draw(rng, data.longest(rng))) for _ in range(views)))


def held_out_latents(temos: Temos, clips: Sequence[ActionClip], data: ActionData) -> Latents:
    """Posteriors of the validation clips, one row per caption."""
    held_out = held_out_examples([clip for clip in clips if clip.split == "val"], data)
    return encode_views(temos, map(_view, held_out))


def _view(example: Example) -> tuple[Floats, tuple[str, ...]]:
    return example.frames.numpy(), tuple(example.texts)


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(DenoiserSettings, args)
    data = from_namespace(ActionData, args)
    sources = {name: _digest(getattr(args, name)) for name in ("corpus", "captions_file", "temos")}
    temos = load_any(args.temos, Temos)
    clips = read_actions(load_recordings(args.corpus), args.captions_file)
    key = [*sources.values(), str(data), str(settings.views), str(schedule.seed)]

    def views() -> Latents:
        return training_latents(temos, clips, data, settings.views, schedule.seed)

    latents = cached_latents(key, views, args.out)
    backbone = open_backbone("onnx", args.encoder)
    speak = TextLatents(temos, SpokenTexts(backbone)).of
    task = LatentDiffusionTask(latents, held_out_latents(temos, clips, data), speak, settings, schedule.seed)
    notes = {**dataclasses.asdict(settings), **dataclasses.asdict(data), "sources": sources}
    notes |= {"network": task.model.config, "backbone": backbone.fingerprint}
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


class TextLatents:
    """The mean latent of texts, each computed once."""

    def __init__(self, temos: Temos, spoken: SpokenTexts) -> None:
        self.temos, self.spoken, self._known = temos.eval(), spoken, dict[tuple[str, ...], Floats]()

    @torch.no_grad()
    def of(self, texts: tuple[str, ...]) -> Floats:
        """(1, 256) of a text, or of several encoded separately."""
        if texts not in self._known:
            tokens, mask = padded([self.spoken.of(texts)])
            self._known[texts] = self.temos.encode_text(tokens, mask).mu.numpy()
        return self._known[texts]


def _digest(path: Path) -> str:
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def parser() -> argparse.ArgumentParser:
    """The command line, every setting with its default."""
    result = recipe_parser(__doc__ or "", Schedule, DenoiserSettings, ActionData)
    result.add_argument("--captions-file", type=Path, required=True, help="captions.jsonl with labels and parts")
    result.add_argument("--temos", type=Path, required=True, help="trained TEMOS: best.pt or models/temos.safetensors")
    result.add_argument("--encoder", type=Path, default=Path("models/tmr_text.int8.onnx"), help="text encoder")
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
