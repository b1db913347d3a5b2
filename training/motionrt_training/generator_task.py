"""The motion denoiser as the trainer sees it: views with what is said, measured and held of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.synthesis.motion_diffusion import held_columns
from motionrt.text import (
    SLOTS,
    TARGETS,
    mirror_known,
    mirror_slots,
    mirror_targets,
    parse_query,
    sideless_slots,
    slots_of_text,
)
from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.corpora.views import Views
from motionrt_training.generator_holding import draw_holding
from motionrt_training.generator_losses import motion_losses
from motionrt_training.generator_trial import Trial
from motionrt_training.networks.motion_denoiser import Condition, MotionDenoiser
from motionrt_training.options import option
from motionrt_training.text_cache import TextFeatures

ACTION = list(SLOTS).index("action")
BUCKET = 4  # batches that are sorted by length together
SMALLEST_STD = 0.05  # of joints, metres
SMALLEST = 1e-3  # of the root's columns, which may be constant
HAND_KEYED = 0.4  # weight of animations that were keyed by hand


@dataclass(frozen=True)
class GeneratorSettings:
    """Network, data and loss."""

    d: int = option(256, "width")
    layers: int = option(6, "layers")
    heads: int = option(4, "attention heads")
    ff: int = option(1024, "feed-forward width")
    patch: int = option(4, "frames of a token")
    batch: int = option(32, "views of a batch")
    words: int = option(24, "tokens of a text that are read")
    untold: float = option(0.1, "part of the views that are trained without any condition, for guidance")
    said_slots: float = option(0.9, "part of the measured slots that are told where the text speaks of them")
    other_slots: float = option(0.4, "part of the other measured slots that are told")
    only_said: float = option(0.3, "part of the views that are told no other slots at all")
    sideless: float = option(0.1, "part of the views whose slots name no sides")
    numbers: float = option(0.3, "part of the views that are told numbers")
    spoken: float = option(0.25, "part of the views whose text was made from what was measured")
    held: float = option(0.5, "part of the views of which something is held")
    level_mean: float = option(0.8, "mean of the logarithm of the noise level")
    level_deviation: float = option(1.4, "its standard deviation")
    detail: float = option(4.0, "largest weight of a low noise level, as 1 + 1 / level^2")


class SpokenLines:
    """Every text once, with token features and slots, and its mirror image."""

    def __init__(self, texts: Sequence[str], features: TextFeatures) -> None:
        self.features = features
        self.place = {text: number for number, text in enumerate(texts)}
        self.slots = np.stack([slots_of_text(parse_query(text)) for text in texts])
        self.mirror = np.array([self.place[mirror_text(text)] for text in texts])

    @staticmethod
    def of(views: Views, further: Sequence[str] = ()) -> list[str]:
        """Every text of the views and its mirror image, once."""
        texts = [text for many in (*views.captions, *(made[:1] for made in views.spoken)) for text in many]
        texts = [*dict.fromkeys([*texts, *further])]
        return list(dict.fromkeys([*texts, *map(mirror_text, texts), *(mirror_text(mirror_text(t)) for t in texts)]))


class GeneratorTask:
    """The task of `Trainer`."""

    def __init__(self, views: Views, lines: SpokenLines, trial: Trial, settings: GeneratorSettings, seed: int) -> None:
        self.views, self.lines, self.trial, self.settings, self.seed = views, lines, trial, settings, seed
        self.captions = [[lines.place[text] for text in many] for many in views.captions]
        self.spoken = [[lines.place[text] for text in many[:1]] for many in views.spoken]
        self.weight = _weights(views)
        torch.manual_seed(seed)
        s = settings
        self.model = MotionDenoiser(
            ego77.WIDTH, s.patch, s.d, s.layers, s.heads, s.ff, lines.features.tokens.shape[1],
            tuple(SLOTS.values()), len(TARGETS), held_columns().tolist(), longest=200 // s.patch,
        )  # fmt: skip
        mean, std = _statistics(views)
        self.model.mean.copy_(torch.from_numpy(mean))
        self.model.std.copy_(torch.from_numpy(std))

    def batch(self, step: int) -> dict[str, Tensor]:
        """Views (B, F, 77), noise, levels (B,) and the fields of `Condition`."""
        rng = np.random.default_rng((self.seed, step, 1))
        rows = self._rows(step)
        s = self.settings
        frames = int(np.ceil(self.views.length[rows].max() / s.patch)) * s.patch
        fields: dict[str, list[Any]] = {name: [] for name in ("motion", "there", "slots", "targets", "known", "text")}
        for row in rows.tolist():
            for name, value in self._view(row, frames, rng).items():
                fields[name].append(value)
        there = np.stack(fields["there"])
        motion = np.stack(fields["motion"])
        tokens, seen = self._tokens(fields["text"])
        levels = np.exp(s.level_mean + s.level_deviation * rng.standard_normal(len(rows)))
        arrays = {
            "motion": motion, "noise": rng.standard_normal(motion.shape, dtype=np.float32),
            "level": np.clip(levels, 0.02, 90.0).astype(np.float32), "frames": there, "tokens": tokens, "text": seen,
            "slots": np.stack(fields["slots"]), "targets": np.stack(fields["targets"]),
            "known": np.stack(fields["known"]), "holding": self._holding(there, rng),
        }  # fmt: skip
        return {name: torch.from_numpy(value) for name, value in arrays.items()}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """See `motion_losses`; low noise levels count more."""
        net, level = self.model, batch["level"]
        clean = net.normalise(batch["motion"]) * batch["frames"][..., None]
        told = Condition(
            **{name: batch[name] for name in ("frames", "tokens", "text", "slots", "targets", "known", "holding")},
            held=batch["motion"],
        )
        found = model(clean + level[:, None, None] * batch["noise"], level, told)
        weight = (1 + level.square().reciprocal()).clamp(max=self.settings.detail)
        return motion_losses(found, clean, net.std, net.mean, batch["frames"], weight)

    def validate(self, model: nn.Module) -> dict[str, float]:
        """What the trial finds; `score` is how well its motions do what their texts say."""
        return self.trial.run(cast("MotionDenoiser", model))

    def _rows(self, step: int) -> NDArray[np.intp]:
        block, index = divmod(step, BUCKET)
        rng, size = np.random.default_rng((self.seed, block)), self.settings.batch
        rows = rng.choice(len(self.views), size * BUCKET, p=self.weight)
        batches = rows[np.argsort(self.views.length[rows], kind="stable")].reshape(BUCKET, size)
        return np.asarray(batches[rng.permutation(BUCKET)[index]])

    def _view(self, row: int, frames: int, rng: np.random.Generator) -> dict[str, Any]:
        s = self.settings
        motion, slots = self.views.motion(row).astype(np.float32), self.views.slots[row]
        targets, known = self.views.targets[row], self.views.known[row]
        text = self._text(row, rng)
        if rng.random() < 0.5:
            motion, slots = ego77.mirrored(motion), mirror_slots(slots)
            targets, known = mirror_targets(targets), mirror_known(known)
            text = None if text is None else int(self.lines.mirror[text])
        padded = np.zeros((frames, ego77.WIDTH), np.float32)
        padded[: len(motion)] = motion
        said = self.lines.slots[text] if text is not None else np.zeros_like(slots)
        slots = self._told(slots, said, rng)
        numbers = known & (rng.random(len(known)) < rng.random()) & (rng.random() < s.numbers)
        if rng.random() < s.untold:
            text, slots, numbers = None, np.zeros_like(slots), np.zeros_like(numbers)
        there = np.arange(frames) < len(motion)
        return {"motion": padded, "there": there, "slots": slots, "targets": targets, "known": numbers, "text": text}

    def _text(self, row: int, rng: np.random.Generator) -> int | None:
        own, made = self.captions[row], self.spoken[row]
        chosen = made if made and (not own or rng.random() < self.settings.spoken) else own
        return int(rng.choice(chosen)) if chosen else None

    def _told(
        self, measured: NDArray[np.int64], said: NDArray[np.int64], rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """Which of the measured slots are told; what the text alone can say of an action."""
        s = self.settings
        measured = measured.copy()
        measured[ACTION] = said[ACTION]
        if rng.random() < s.sideless:
            measured = sideless_slots(measured)
        others = 0.0 if rng.random() < s.only_said else s.other_slots
        kept = rng.random(len(measured)) < np.where(said > 0, s.said_slots, others)
        return np.where(kept, measured, 0)

    def _tokens(self, texts: list[int | None]) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Token features (B, T, 384) and which of them there are (B, T)."""
        found = [None if text is None else self.lines.features.of(text)[: self.settings.words] for text in texts]
        longest = max([1, *(len(rows) for rows in found if rows is not None)])
        tokens = np.zeros((len(texts), longest, self.lines.features.tokens.shape[1]), np.float32)
        seen = np.zeros((len(texts), longest), bool)
        for number, rows in enumerate(found):
            if rows is not None:
                tokens[number, : len(rows)], seen[number, : len(rows)] = rows, True
        return tokens, seen

    def _holding(self, there: NDArray[np.bool_], rng: np.random.Generator) -> NDArray[np.bool_]:
        holding = np.zeros((*there.shape, len(PARTS)), bool)
        for number, row in enumerate(there):
            if rng.random() < self.settings.held:
                count = int(row.sum())
                holding[number, :count] = draw_holding(count, rng)
        return holding


def _weights(views: Views) -> NDArray[np.float64]:
    """How often each view is drawn: the rarer what it does, the oftener, up to five times; hand-keyed ones less."""
    rare = np.ones(len(views))
    for column in views.slots.T:
        often = np.bincount(column, minlength=int(column.max()) + 1)
        share = np.maximum(often[column], 1) / len(views)
        rare = np.maximum(rare, np.where(column > 0, np.sqrt(0.1 / share), 1.0))
    keyed = np.array([HAND_KEYED if source == "cc0" else 1.0 for source in views.sources])
    weight = np.clip(rare, 1, 5) * keyed
    return np.asarray(weight / weight.sum())


def _statistics(views: Views) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Mean and standard deviation (77,) of views and their mirror images."""
    rows = views.features[:: max(1, len(views.features) // 400000)].astype(np.float32)
    both = np.concatenate([rows, ego77.mirrored(rows)])
    mean, std = both.mean(0), both.std(0)
    std[ego77.JOINTS] = np.maximum(std[ego77.JOINTS], SMALLEST_STD)
    mean[ego77.CONTACTS], std[ego77.CONTACTS] = 0.5, 0.5
    std = np.maximum(std, SMALLEST)
    return mean, std
