"""TMR as the trainer sees it: batches of a packed corpus, the losses, retrieval on the validation split."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import torch
from torch import Tensor, nn

from motionrt_training import losses as L
from motionrt_training.augment import Augmentation, view_motion, view_text
from motionrt_training.batches import EpochPlan, padded
from motionrt_training.networks.actor import Distribution
from motionrt_training.networks.tmr import TMR
from motionrt_training.options import option
from motionrt_training.packed import PackedCorpus, statistics
from motionrt_training.text_cache import TextFeatures
from motionrt_training.text_filter import directions, keep_negatives
from motionrt_training.validation import split_measures


@dataclass(frozen=True)
class TmrSettings:
    """Network, data and losses of TMR; weights and sizes of the paper unless the help says otherwise."""

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
    directions: bool = option(True, "never drop a negative whose side or direction words differ")
    temperature: float = option(0.1, "temperature of InfoNCE")
    contrastive_weight: float = option(0.1, "weight of the contrastive term")
    kl_weight: float = option(1e-5, "weight of the four KL terms")
    latent_weight: float = option(1e-5, "weight of the distance between the latents")
    contrast: str = option("sample", "latents of the contrastive term", ("sample", "mean"))
    reconstruct: str = option(
        "alternate", "decode both latents, or a random one per motion with weight 2", ("both", "alternate")
    )
    mirror: bool = option(True, "mirror half of the motions, with left and right swapped in the text")
    crop: float = option(0.6, "least part of a clip that a random crop keeps")
    speed: float = option(0.1, "largest random change of speed")
    most_frames: int = option(200, "longest crop, frames at 20 fps")
    noise: float = option(0.02, "noise on the normalised features that the encoder sees")
    token_dropout: float = option(0.0, "part of the text tokens hidden in training")
    equalise: bool = option(True, "one standard deviation per kind of feature")


class TmrTask:
    """The task of `Trainer` for a packed corpus and the features of all its texts."""

    def __init__(self, corpus: PackedCorpus, texts: TextFeatures, settings: TmrSettings, seed: int) -> None:
        self.corpus, self.texts, self.settings = corpus, texts, settings
        self.index = {text: number for number, text in enumerate(corpus.texts())}
        self.directions = [directions(text) for text in self.index]
        self.clips = corpus.split("train")
        rules = Augmentation(settings.mirror, settings.crop, most=settings.most_frames, speed=settings.speed)
        self.plan = EpochPlan(self.clips, settings.batch, rules, seed, settings.bucket)
        torch.manual_seed(seed)
        self.model: TMR = build(corpus, texts, settings)

    def batch(self, step: int) -> dict[str, Tensor]:
        """Motion (B, F, 263) raw with mask, tokens (B, T, 384) with mask, keep (B, B)."""
        chosen = [(self.clips[clip], view) for clip, view in self.plan.at(step)]
        motion, mask = padded([view_motion(self.corpus, clip, view) for clip, view in chosen])
        numbers = [self.index[view_text(clip, view)] for clip, view in chosen]
        tokens, token_mask = padded([self.texts.of(number) for number in numbers])
        keep = keep_negatives(
            self.texts.sentences[numbers],
            [self.directions[number] for number in numbers],
            self.settings.threshold,
            respect_directions=self.settings.directions,
        )
        parts = {"motion": motion, "mask": mask, "tokens": tokens, "token_mask": token_mask}
        return {**parts, "keep": torch.from_numpy(keep)}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """The terms of TMR and their weighted sum."""
        s = self.settings
        motion, mask = self.model.normalise(batch["motion"]), batch["mask"]
        seen = motion + s.noise * torch.randn_like(motion) if s.noise else motion
        token_mask = hide(batch["token_mask"], s.token_dropout)
        text, moved = model(batch["tokens"], token_mask, seen, mask)
        z_text, z_motion = text.sample(), moved.sample()
        terms = {"kl": L.kl_terms(text, moved), "latent": L.latent_distance(z_text, z_motion)}
        loss = s.kl_weight * terms["kl"] + s.latent_weight * terms["latent"]
        if s.reconstruction:
            terms["reconstruction"] = self._reconstruction(z_text, z_motion, motion, mask)
            loss = loss + terms["reconstruction"]
        if s.contrastive:
            terms["contrastive"] = self._contrastive(text, moved, z_text, z_motion, batch["keep"])
            loss = loss + s.contrastive_weight * terms["contrastive"]
        return {"loss": loss, **terms}

    def _contrastive(
        self, text: Distribution, motion: Distribution, z_text: Tensor, z_motion: Tensor, keep: Tensor
    ) -> Tensor:
        s = self.settings
        left, right = (z_text, z_motion) if s.contrast == "sample" else (text.mu, motion.mu)
        if s.margin:
            return L.margin_loss(left, right, keep, s.margin_size)
        return L.info_nce(left, right, keep, s.temperature)

    def _reconstruction(self, z_text: Tensor, z_motion: Tensor, motion: Tensor, mask: Tensor) -> Tensor:
        """From text plus from motion; `alternate` decodes one per motion: equal on average, half the work."""
        if self.settings.reconstruct == "both":
            decoded = self.model.motion_decoder(torch.cat((z_text, z_motion)), mask.repeat(2, 1))
            return 2.0 * L.reconstruction(decoded, motion.repeat(2, 1, 1), mask.repeat(2, 1)).mean()
        from_text = torch.rand(len(z_text), 1, device=z_text.device) < 0.5
        decoded = self.model.motion_decoder(torch.where(from_text, z_text, z_motion), mask)
        return 2.0 * L.reconstruction(decoded, motion, mask).mean()

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Retrieval on the validation split, whose mean recall is the score; the test split is watched."""
        network = cast("TMR", model)
        data = (self.corpus, self.texts, self.index)
        measures = split_measures(network, *data, "val", self.settings.most_frames)
        test = split_measures(network, *data, "test", self.settings.most_frames)
        return {**measures, **{f"test_{name}": value for name, value in test.items()}}


def build(corpus: PackedCorpus, texts: TextFeatures, settings: TmrSettings) -> TMR:
    """The network of the settings, with the statistics of the training split."""
    s = settings
    width = corpus.features.shape[1]
    model = TMR(texts.tokens.shape[1], width, s.d, s.layers, s.heads, s.ff, s.dropout, s.patch)
    mean, std = statistics(corpus, equalise=s.equalise)
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
