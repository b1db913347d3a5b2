"""TMR as the trainer sees it: batches of a packed corpus, the losses, retrieval on the validation split."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from motionrt.motion.features import guo263
from motionrt.text import SLOTS, parse_query, slots_of_text
from motionrt_training import losses as L
from motionrt_training.augment import Augmentation, View, mirrored, straightened, view_motion, view_slots, view_text
from motionrt_training.batches import EpochPlan, padded
from motionrt_training.networks.actor import Distribution
from motionrt_training.networks.tmr import TMR
from motionrt_training.options import option
from motionrt_training.packed import PackedClip, PackedCorpus, mirror_columns, statistics
from motionrt_training.text_cache import TextFeatures
from motionrt_training.text_filter import directions, keep_negatives, names_path
from motionrt_training.validation import contrast_measures, split_measures

UNSEEN = 1e6  # a standard deviation that hides a column
Look = tuple[PackedClip, View]


@dataclass(frozen=True)
class TmrSettings:
    """Network, data and losses of TMR. What the paper has otherwise says so; `docs/train.md` turns it off."""

    d: int = option(256, "width and size of the latent")
    layers: int = option(6, "layers of each network")
    heads: int = option(4, "attention heads")
    ff: int = option(1024, "feed-forward width")
    dropout: float = option(0.1, "dropout rate")
    patch: int = option(4, "frames per token of the motion networks (the paper: 1)")
    batch: int = option(32, "clips per batch")
    bucket: int = option(4, "batches that are sorted by length together; 1 for fully random batches")
    contrastive: bool = option(True, "contrastive term (off: TEMOS-style, table 3)")
    reconstruction: bool = option(True, "reconstruction term (table 3)")
    margin: bool = option(False, "margin loss in place of InfoNCE (table 3)")
    margin_size: float = option(1.0, "distance beyond which the margin loss leaves negatives alone")
    threshold: float | None = option(0.8, "text similarity (0 to 1) above which negatives are dropped (table 4)")
    directions: bool = option(True, "never drop a negative whose side or direction words differ (not in the paper)")
    temperature: float = option(0.1, "temperature of InfoNCE")
    contrastive_weight: float = option(0.1, "weight of the contrastive term")
    kl_weight: float = option(1e-5, "weight of the four KL terms")
    latent_weight: float = option(1e-5, "weight of the distance between the latents")
    contrast: str = option("sample", "latents of the contrastive term", ("sample", "mean"))
    reconstruct: str = option(
        "alternate", "decode both latents, or a random one per motion with weight 2", ("both", "alternate")
    )
    mirror: bool = option(True, "mirror half of the motions, with left and right swapped in the text")
    crop: float = option(0.6, "least part of a clip that a random crop keeps (not in the paper)")
    speed: float = option(0.1, "largest random change of speed (not in the paper)")
    most_frames: int = option(200, "longest crop, frames at 20 fps")
    noise: float = option(0.02, "noise on the normalised features that the encoder sees (not in the paper)")
    token_dropout: float = option(0.0, "part of the text tokens hidden in training (not in the paper)")
    equalise: bool = option(True, "one standard deviation per kind of feature")
    rotations: bool = option(True, "the motion encoder sees the rotations, which follow from the positions")
    decoder_layers: int | None = option(None, "layers of the decoder; none takes --layers")
    encoder: str = option("transformer", "kind of both encoders; gru is Guo's, a rival", ("transformer", "gru"))
    twins: bool = option(True, "the mirror image of every clip and caption is in the same batch (not in the paper)")
    straightened: bool = option(
        True, "clips that name a path are negatives of it without their turn (not in the paper)"
    )
    hard: float = option(3.0, "how many negatives a mirror image or a straightened clip counts for")
    slots: float = option(0.3, "weight of telling slots from a motion's and a text's latent (not in the paper)")
    spoken: float = option(0.25, "part of the views whose text was made from what was measured (not in the paper)")


class TmrTask:
    """The task of `Trainer` for a packed corpus and the features of all its texts."""

    def __init__(self, corpus: PackedCorpus, texts: TextFeatures, settings: TmrSettings, seed: int) -> None:
        if corpus.mirror is guo263.mirror and not settings.rotations:
            corpus = replace(corpus, mirror=mirror_columns)
        self.corpus, self.texts, self.settings = corpus, texts, settings
        self.said = corpus.texts()
        self.index = {text: number for number, text in enumerate(self.said)}
        self.directions = [directions(text) for text in self.said]
        self.slots = text_slots(self.said) if settings.slots and has_slots(corpus) else None
        self.clips = corpus.split("train")
        s = settings
        rules = Augmentation(s.mirror, s.crop, most=s.most_frames, speed=s.speed, spoken=s.spoken)
        self.plan = EpochPlan(self.clips, s.batch, rules, seed, s.bucket)
        torch.manual_seed(seed)
        self.model: TMR = build(corpus, texts, settings)

    def batch(self, step: int) -> dict[str, Tensor]:
        """Motions (M, F, 263) raw with mask, tokens (T, N, 384) with mask, positive and negative (T, M), slots.

        The M motions are the clips of the step, their mirror images, and the clips whose turn was taken out.
        """
        chosen = [(self.clips[clip], view) for clip, view in self.plan.at(step)]
        looks = [*chosen, *(mirrored(chosen) if self.settings.twins else ())]
        rows, owner = distinct([self.index[view_text(clip, view)] for clip, view in looks])
        shown = [view_motion(self.corpus, clip, view) for clip, view in chosen]
        if self.settings.twins:
            shown += [self.corpus.mirror(motion) for motion in shown]
        bent = self._bent(looks) if self.settings.straightened else []
        motion, mask = padded([*shown, *(straightened(shown[i]) for i in bent)])
        tokens, token_mask = padded([self.texts.of(number) for number in rows])
        positive, negative = self._pairs(looks, rows, owner, bent)
        parts = {"motion": motion, "mask": mask, "tokens": tokens, "token_mask": token_mask}
        parts |= {"positive": torch.from_numpy(positive), "negative": torch.from_numpy(negative)}
        if self.slots is not None:
            unknown = (0,) * self.slots.shape[1]
            seen = np.array([view_slots(clip, view) or unknown for clip, view in looks], dtype=np.int64)
            parts |= {"slots": torch.from_numpy(seen), "text_slots": torch.from_numpy(self.slots[rows])}
        return parts

    def _bent(self, looks: Sequence[Look]) -> list[int]:
        """Which motions turn and are said to."""
        return [i for i, (clip, view) in enumerate(looks) if names_path(view_text(clip, view))]

    def _pairs(
        self, looks: Sequence[Look], rows: list[int], owner: NDArray[np.int64], bent: list[int]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:
        """Positive (T, M) and the weights of the negatives (T, M), see `losses.paired_nce`."""
        s = self.settings
        groups = [self.directions[number] for number in rows]
        keep = keep_negatives(self.texts.sentences[rows], groups, s.threshold, respect_directions=s.directions)
        texts = np.arange(len(rows))[:, None]
        positive = texts == owner[None]
        negative = keep[:, owner].astype(np.float32)
        names = np.array([clip.group for clip, _ in looks])
        spoken = [{name for name, row in zip(names, owner, strict=True) if row == text} for text in range(len(rows))]
        related = np.array([[name in group for name in names] for group in spoken])
        negative = np.where(related, 0.0, negative)
        twin = np.roll(np.arange(len(looks)), len(looks) // 2) if s.twins else np.arange(0)
        for own, other in enumerate(twin):  # a sided caption is told from the mirror image of its clip
            negative[owner[own], other] = s.hard
        without = np.zeros((len(rows), len(bent)), dtype=np.float32)
        without[owner[bent], np.arange(len(bent))] = s.hard
        positive = np.concatenate([positive, np.zeros_like(without, dtype=np.bool_)], axis=1)
        return positive, np.where(positive, 0.0, np.concatenate([negative, without], axis=1)).astype(np.float32)

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """The terms of TMR and their weighted sum."""
        s = self.settings
        motion, mask = self.model.normalise(batch["motion"]), batch["mask"]
        seen = motion + s.noise * torch.randn_like(motion) if s.noise else motion
        token_mask = hide(batch["token_mask"], s.token_dropout)
        text, moved = model(batch["tokens"], token_mask, seen, mask)
        pairs = batch["positive"].nonzero(as_tuple=True)
        said = Distribution(text.mu[pairs[0]], text.logvar[pairs[0]])  # (P, d): the text of every pair
        shown = Distribution(moved.mu[pairs[1]], moved.logvar[pairs[1]])
        z_text, z_motion = said.sample(), shown.sample()
        terms = {"kl": L.kl_terms(said, shown), "latent": L.latent_distance(z_text, z_motion)}
        loss = s.kl_weight * terms["kl"] + s.latent_weight * terms["latent"]
        if s.reconstruction:
            few = pairs[1] < s.batch  # mirror images bring nothing new to a decoder that sees both sides
            part = (z_text[few], z_motion[few], motion[pairs[1][few]], mask[pairs[1][few]])
            terms["reconstruction"] = self._reconstruction(*part)
            loss = loss + terms["reconstruction"]
        if s.contrastive:
            terms["contrastive"] = self._contrastive(text, moved, batch)
            loss = loss + s.contrastive_weight * terms["contrastive"]
        if "slots" in batch:
            terms |= self._slots(text, moved, batch)
            loss = loss + s.slots * (terms["motion_slots"] + terms["text_slots"])
        return {"loss": loss, **terms}

    def _contrastive(self, text: Distribution, motion: Distribution, batch: Any) -> Tensor:
        s = self.settings
        left, right = (text.sample(), motion.sample()) if s.contrast == "sample" else (text.mu, motion.mu)
        positive, negative = batch["positive"], batch["negative"]
        if s.margin:
            return L.margin_loss(left, right, positive, negative > 0, s.margin_size)
        return L.paired_nce(left, right, positive, negative, s.temperature)

    def _slots(self, text: Distribution, motion: Distribution, batch: Any) -> dict[str, Tensor]:
        read, sizes = self.model.slots, self.model.config["slots"]
        assert read is not None
        shown = read(motion.mu[: len(batch["slots"])])
        return {
            "motion_slots": L.slot_loss(shown, batch["slots"], sizes),
            "text_slots": L.slot_loss(read(text.mu), batch["text_slots"], sizes),
        }

    def _reconstruction(self, z_text: Tensor, z_motion: Tensor, motion: Tensor, mask: Tensor) -> Tensor:
        """From text plus from motion; `alternate` decodes one per motion: equal on average, half the work."""
        if self.settings.reconstruct == "both":
            decoded = self.model.motion_decoder(torch.cat((z_text, z_motion)), mask.repeat(2, 1))
            return 2.0 * L.reconstruction(decoded, motion.repeat(2, 1, 1), mask.repeat(2, 1)).mean()
        from_text = torch.rand(len(z_text), 1, device=z_text.device) < 0.5
        decoded = self.model.motion_decoder(torch.where(from_text, z_text, z_motion), mask)
        return 2.0 * L.reconstruction(decoded, motion, mask).mean()

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Retrieval, sides and turns on the validation split, whose mean is the score; the test split is watched."""
        network = cast("TMR", model)
        data = (self.corpus, self.texts, self.index)
        both = [
            split_measures(network, *data, split, self.settings.most_frames)
            | contrast_measures(network, *data, split, self.settings.most_frames)
            for split in ("val", "test")
        ]
        measures, test = both
        measures["score"] = float(np.mean([measures[name] for name in ("score", "side", "path") if name in measures]))
        return {**measures, **{f"test_{name}": value for name, value in test.items()}}


def has_slots(corpus: PackedCorpus) -> bool:
    """Whether the corpus was packed with what its windows measure."""
    return any(clip.windows and clip.windows[0].slots for clip in corpus.clips)


def text_slots(texts: Sequence[str]) -> NDArray[np.int64]:
    """What each text says of every slot (N, S), 0 where it says nothing."""
    return np.stack([slots_of_text(parse_query(text)) for text in texts]).astype(np.int64)


def distinct(numbers: Sequence[int]) -> tuple[list[int], NDArray[np.int64]]:
    """Every number once, in order of appearance, and where each of `numbers` is found among them."""
    rows = list(dict.fromkeys(numbers))
    place = {number: row for row, number in enumerate(rows)}
    return rows, np.array([place[number] for number in numbers])


def build(corpus: PackedCorpus, texts: TextFeatures, settings: TmrSettings) -> TMR:
    """The network of the settings, with the statistics of the training split."""
    s = settings
    width = corpus.features.shape[1]
    slots = [size - 1 for size in SLOTS.values()] if s.slots and has_slots(corpus) else []
    sizes = (s.d, s.layers, s.heads, s.ff, s.dropout, s.patch, s.decoder_layers)
    model = TMR(texts.tokens.shape[1], width, *sizes, slots, encoder=s.encoder)
    mean, std = statistics(corpus, equalise=s.equalise)
    if width == guo263.WIDTH and not s.rotations:
        std[guo263.ROTATIONS] = UNSEEN
    model.motion_mean.copy_(torch.from_numpy(mean))
    model.motion_std.copy_(torch.from_numpy(std))
    return model


def hide(mask: Tensor, rate: float) -> Tensor:
    """Hide a random part of the tokens of each text (never its first)."""
    if not rate:
        return mask
    shown = torch.rand(mask.shape, device=mask.device) >= rate
    shown[:, 0] = True
    return mask & shown
