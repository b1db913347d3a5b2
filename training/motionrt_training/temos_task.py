"""TEMOS as the trainer sees it: sentences and motions of simultaneous actions, the losses of SINC eq. 1, validation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training import losses as L
from motionrt_training.batches import padded
from motionrt_training.corpora.actions import ActionClip
from motionrt_training.networks import egocentric
from motionrt_training.networks.kinematics import joint_positions
from motionrt_training.networks.temos import Temos
from motionrt_training.options import option
from motionrt_training.temos_data import ActionData, Example, Examples, SpokenTexts

FPS = 30.0
VALIDATED = 64  # examples


@dataclass(frozen=True)
class TemosSettings:
    """Network and losses. SINC eq. 1 has no weights and names 6 heads; TEMOS and TMR weigh KL and latents by 1e-5."""

    d: int = option(256, "width and size of the latent")
    layers: int = option(6, "layers of each network")
    heads: int = option(4, "attention heads (SINC: 6, which does not divide 256)")
    ff: int = option(1024, "feed-forward width")
    dropout: float = option(0.1, "dropout rate")
    patch: int = option(8, "frames per token of the motion networks (the paper: 1)")
    batch: int = option(40, "examples per batch (SINC: 64)")
    kl_weight: float = option(1e-4, "weight of the four KL terms (TEMOS: 1e-5; SINC eq. 1: 1)")
    latent_weight: float = option(1e-4, "weight of the distance between the latents (TEMOS: 1e-5; SINC eq. 1: 1)")
    from_text: float = option(0.3, "part of the reconstructions that start from the text's latent (the paper: 0.5)")
    place: float = option(1.0, "weight of the joints' places about the pelvis, metres (the paper: 0)")
    speed: float = option(0.02, "weight of the joints' velocities over the ground, m/s (the paper: 0)")
    path: float = option(0.05, "weight of the trajectory, metres (the paper: part of the features)")
    measured: float = option(0.5, "part of the examples whose joints are measured")
    noise: float = option(0.02, "noise on the normalised frames that the encoder sees")


class TemosTask:
    """The task of `Trainer`."""

    def __init__(
        self, clips: Sequence[ActionClip], texts: SpokenTexts, settings: TemosSettings, data: ActionData, seed: int
    ) -> None:
        self.settings, self.texts, self.seed = settings, texts, seed
        self.train = Examples([clip for clip in clips if clip.split == "train"], data)
        held_out = [clip for clip in clips if clip.split == "val"]
        self.held_out = held_out_examples(held_out, data)
        torch.manual_seed(seed)
        s = settings
        self.model: Temos = Temos(
            d=s.d, layers=s.layers, heads=s.heads, ff=s.ff, dropout=s.dropout, patch=s.patch, separation=data.separate
        )
        set_statistics(self.model, [clip.frames for clip in self.train.clips])

    def batch(self, step: int) -> dict[str, Tensor]:
        """Frames (B, F, 136) normalised with mask, tokens (B, T, 384) with mask."""
        rng = np.random.default_rng((self.seed, step))
        longest = self.train.data.longest(rng)
        return self.collate([self.train.draw(rng, longest) for _ in range(self.settings.batch)])

    def collate(self, examples: Sequence[Example]) -> dict[str, Tensor]:
        """Pad examples to a batch, the longest first dimension that any of them needs."""
        frames, mask = padded([example.frames.numpy() for example in examples])
        tokens, token_mask = padded([self.texts.of(example.texts) for example in examples])
        return {"frames": frames, "mask": mask, "tokens": tokens, "token_mask": token_mask}

    def losses(self, model: nn.Module, batch: Any) -> dict[str, Tensor]:
        """The terms of SINC eq. 1, and of the places and velocities of the joints."""
        s, net, mask = self.settings, self.model, batch["mask"]
        frames = net.normalise(batch["frames"])
        seen = frames + s.noise * torch.randn_like(frames) if s.noise else frames
        text, motion = model(batch["tokens"], batch["token_mask"], seen, mask)
        z_text, z_motion = text.sample(), motion.sample()
        choose = torch.rand(len(z_text), 1, device=z_text.device) < s.from_text
        latent = torch.where(choose, z_text, z_motion)
        decoded = net.motion_decoder(latent, mask)
        with torch.autocast(frames.device.type, enabled=False):
            some = slice(0, max(1, round(s.measured * len(decoded))))
            parts = reconstruction(net.denormalise(decoded[some]), batch["frames"][some], mask[some])
            parts["feature"] = 2.0 * L.reconstruction(decoded, frames, mask).mean()
            parts |= {"kl": L.kl_terms(text, motion), "latent": L.latent_distance(z_text, z_motion)}
        weights = {"feature": 1.0, "place": s.place, "speed": s.speed, "path": s.path}
        weights |= {"kl": s.kl_weight, "latent": s.latent_weight}
        return {"loss": sum((weights[k] * v for k, v in parts.items()), torch.zeros(())), **parts}

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Errors of held-out motions decoded from their own latents and from their texts' mean latents."""
        if not self.held_out:
            return {}
        net = cast("Temos", model)
        device = net.frame_mean.device
        batch = {k: v.to(device) for k, v in self.collate(self.held_out).items()}
        text, motion = net(batch["tokens"], batch["token_mask"], net.normalise(batch["frames"]), batch["mask"])
        found = {}
        for name, latent in (("motion", motion.mu), ("text", text.mu)):
            decoded = net.denormalise(net.motion_decoder(latent, batch["mask"]))
            parts = reconstruction(decoded, batch["frames"], batch["mask"])
            found |= {f"{name}_{key}": float(value) for key, value in parts.items()}
        found["temos"] = float(0.5 * (1.0 + F.cosine_similarity(text.mu, motion.mu).mean()))
        found["spread"] = float(torch.exp(0.5 * text.logvar).mean())
        found["sharp"] = float(motion.mu.std(0).mean() / torch.exp(0.5 * motion.logvar).mean())
        return {**found, "score": -found["motion_place"] - 0.1 * found["motion_speed"]}


def reconstruction(decoded: Tensor, truth: Tensor, mask: Tensor) -> dict[str, Tensor]:
    """Errors of decoded frames (B, F, 136): joints about the pelvis, their velocities over the ground, the path."""
    with torch.no_grad():
        true_place, true_rate, true_path = _seen(truth)
    place, rate, path = _seen(decoded.float())
    steps = (mask[:, 1:] & mask[:, :-1]).float()
    return {
        "place": _mean(_huber(place - true_place, 0.05).mean(2), mask.float()),
        "speed": _mean(_huber(rate - true_rate, 0.5).mean(2), steps),
        "path": _mean(_huber(path - true_path, 0.5), mask.float()),
    }


def _seen(frames: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Joints about the pelvis, their velocities over the ground and the trajectory of frames (B, F, 136)."""
    joints = joint_positions(egocentric.rotations(frames), _lifted(frames))
    return joints, ground_velocity(frames, joints), egocentric.from_egocentric(frames)[..., 132:134]


def ground_velocity(frames: Tensor, joints: Tensor) -> Tensor:
    """Velocity of joints (B, F, 24, 3) over the ground, seen from the body: (B, F-1, 24, 3), m/s."""
    turn = frames[:, :-1, None, 0]
    sine, cosine = turn.sin(), turn.cos()
    after = joints[:, 1:]
    x = cosine * after[..., 0] + sine * after[..., 2] + frames[:, :-1, None, 1] - joints[:, :-1, :, 0]
    z = cosine * after[..., 2] - sine * after[..., 0] + frames[:, :-1, None, 2] - joints[:, :-1, :, 2]
    return FPS * torch.stack((x, after[..., 1] - joints[:, :-1, :, 1], z), dim=-1)


def set_statistics(model: Temos, clips: Sequence[Tensor]) -> None:
    """Mean and deviation of the frames and of their mirror images; one deviation per kind of feature."""
    frames = torch.cat([*clips, *(egocentric.mirrored(clip) for clip in clips)])
    std = frames.std(0)
    for group in egocentric.GROUPS:
        std[group] = std[group].mean().clamp(min=1e-3)
    model.frame_mean.copy_(frames.mean(0))
    model.frame_std.copy_(std)


def held_out_examples(clips: Sequence[ActionClip], data: ActionData) -> list[Example]:
    """The beginning of every clip with its captions, not more than VALIDATED."""
    pairs = [(clip, caption) for clip in clips for caption in clip.captions]
    every = max(1, len(pairs) // VALIDATED)
    return [Example(clip.frames[: data.most_frames], (caption,)) for clip, caption in pairs[::every]]


def _lifted(frames: Tensor) -> Tensor:
    """The pelvis (B, F, 3) at its height above the origin."""
    return F.pad(frames[..., egocentric.HEIGHT], (1, 1))


def _huber(x: Tensor, beta: float) -> Tensor:
    """Length of (..., D), squared below `beta`."""
    length = (x.square().sum(-1) + 1e-10).sqrt()
    return torch.where(length < beta, 0.5 * length.square() / beta, length - 0.5 * beta)


def _mean(values: Tensor, weight: Tensor) -> Tensor:
    """Mean over valid frames."""
    return (values * weight).sum() / weight.sum().clamp(min=1.0)
