"""TEMOS and the latent denoiser as they are exported: the numbers of `motionrt_training.networks`, fewer operators."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt_export.graphs import DistributionGraph
from motionrt_export.layers import Encoder, Residual, constant, folded, linear
from motionrt_training.networks.actor import patched
from motionrt_training.networks.egocentric import to_egocentric
from motionrt_training.networks.latent_denoiser import WAVES, LatentDenoiser
from motionrt_training.networks.temos import Temos, bounded_logvar
from motionrt_training.networks.transformer import MASKED, key_bias, sinusoidal_positions

PLACED = (1, 4, 7, 2, 6, 9, 0, 3, 5, 8, *range(10, 136))
"""Columns of an egocentric frame as the decoder answers: all x that turn with the heading, all z, the rest."""


class TemosTextGraph(nn.Module):
    """Token features of the sentence encoder -> mu and logvar."""

    def __init__(self, model: Temos) -> None:
        super().__init__()
        self.encoder = DistributionGraph(model.text_encoder)
        self.text_mu = model.text_mu

    def forward(self, token_features: Tensor, attention_mask: Tensor) -> tuple[Tensor, Tensor]:
        """(B, T, 384), (B, T) int64 -> (B, d), (B, d)."""
        mu, logvar = self.encoder(token_features, attention_mask.to(torch.bool))
        return self.text_mu(mu), logvar


class TemosMotionGraph(nn.Module):
    """Raw sinc135 -> mu and logvar: the last layer answers for those two."""

    def __init__(self, model: Temos) -> None:
        super().__init__()
        source = model.motion_encoder
        self.d, self.patch, self.most = source.d, source.patch, source.most
        self.mean, self.rate = constant(model.frame_mean), constant(1.0 / model.frame_std)
        self.project, self.gather = source.project, source.gather
        self.nothing = constant(torch.zeros(1, self.most, self.d))
        last = len(source.layers) - 1
        self.layers = nn.ModuleList(
            Residual(layer, first=2 if index == last else None) for index, layer in enumerate(source.layers)
        )

    def forward(self, motion: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
        """(B, F, 135), (B, F) bool, F <= 300 -> (B, d), (B, d)."""
        x, valid = patched((seen_frames(motion, mask) - self.mean) * self.rate, mask, self.patch)
        x = self.project(x) * valid[:, :, None]
        everything = torch.cat((x, self.nothing.expand(x.shape[0], -1, -1)), dim=1)[:, : self.most]
        summary = self.gather(everything.reshape(x.shape[0], 1, self.most * self.d)).view(x.shape[0], 2, self.d)
        x = torch.cat((summary, x + sinusoidal_positions(x.shape[1], self.d, x)), dim=1)
        always = torch.ones_like(mask[:, :1])
        bias = key_bias(torch.cat((always, always, valid), dim=1))
        for layer in self.layers:
            x = layer(x, bias)
        return x[:, 0], bounded_logvar(x[:, 1])


def seen_frames(motion: Tensor, mask: Tensor) -> Tensor:
    """Egocentric frames (B, F, 136); the last one of each row stands still, as nothing comes after it."""
    frames = to_egocentric(motion)
    after = torch.cat((mask[:, 1:], torch.zeros_like(mask[:, :1])), dim=1)
    return torch.cat((frames[:, :, :3] * after[:, :, None], frames[:, :, 3:]), dim=2)


class TemosDecoderGraph(nn.Module):
    """Latent -> raw sinc135; one Linear gives the queries and what every layer hears of the latent.

    Positions are folded into its bias, the statistics into the last product, whose columns come in the order `PLACED`.
    """

    def __init__(self, model: Temos) -> None:
        super().__init__()
        source = model.motion_decoder
        self.d, self.patch, self.most = source.d, source.patch, source.most
        cross, queries = folded([layer.cross for layer in source.layers]), source.spread
        places = sinusoidal_positions(self.most, self.d, queries.bias).flatten()
        weight = torch.cat((cross.weight, queries.weight))
        self.hear = linear(weight, torch.cat((cross.bias, queries.bias + places)))
        self.layers = nn.ModuleList(Residual(layer) for layer in source.layers)
        self.project = placed(source.project, model.frame_mean, model.frame_std)

    def forward(self, latent: Tensor, mask: Tensor) -> Tensor:
        """(B, d), (B, F) bool, F <= 300 -> (B, F, 135), zeros where the mask is False."""
        valid = mask[:, :: self.patch]  # (B, T)
        heard = self.hear(latent[:, None]).view(latent.shape[0], len(self.layers) + self.most, self.d)
        x, bias = heard[:, len(self.layers) :][:, : valid.shape[1]], key_bias(valid)
        for index, layer in enumerate(self.layers):
            x = layer(x, bias, heard[:, index : index + 1])
        frames = self.project(x).view(latent.shape[0], -1, len(PLACED))[:, : mask.shape[1]]
        return walked(frames) * mask[..., None]


def placed(project: nn.Linear, mean: Tensor, std: Tensor) -> nn.Linear:
    """An output projection with the statistics inside, whose frames come in the order `PLACED`."""
    order = list(PLACED)
    weight, bias = project.weight.unflatten(0, (-1, len(order))), project.bias.unflatten(0, (-1, len(order)))
    weight, bias = (weight * std[:, None])[:, order], (bias * std + mean)[:, order]
    return linear(weight.flatten(0, 1), bias.flatten())


def walked(frames: Tensor) -> Tensor:
    """`from_egocentric` of frames (B, F, 136) in the order `PLACED` -> (B, F, 135)."""
    x, z, turn, rest = frames.split((3, 3, 1, 129), dim=2)  # of x and z: step, left axis, up axis
    yaw = before(turn)
    cos, sin = yaw.cos(), yaw.sin()
    x, z = cos * x + sin * z, cos * z - sin * x
    place = before(torch.cat((x[:, :, :1], z[:, :, :1]), dim=2))
    height, left, up, joints = rest.split((1, 1, 1, 126), dim=2)
    axes = x[:, :, 1:2], left, z[:, :, 1:2], x[:, :, 2:], up, z[:, :, 2:]
    return torch.cat((*axes, joints, place, height), dim=2)


def before(changes: Tensor) -> Tensor:
    """Sums over the frames before each."""
    return torch.cat((torch.zeros_like(changes[:, :1]), changes[:, :-1]), dim=1).cumsum(1)


class LatentDenoiserGraph(nn.Module):
    """`LatentDenoiser.guided` of one token of text: with and without it in one sequence, whose parts are apart.

    The sequence is the latent and the time twice, and the text, which only the first of each two may see. Time has a
    token and an angle in store for every step.
    """

    def __init__(self, source: LatentDenoiser) -> None:
        super().__init__()
        self.d, last = source.d, len(source.layers) - 1
        self.layers = nn.ModuleList(
            Encoder(layer, first=2 if index == last else None) for index, layer in enumerate(source.layers)
        )
        self.skips, self.out = source.skips, source.out
        positions = sinusoidal_positions(3, self.d, source.angle)
        self.read_latent = linear(source.read_latent.weight, source.read_latent.bias + positions[0])
        self.read_text = linear(source.read_text.weight, source.read_text.bias + positions[2])
        waves = source.angle[:, None] * torch.arange(1, WAVES + 1)
        with torch.no_grad():
            time = source.read_time(torch.cat((waves.sin(), waves.cos()), dim=1)) + positions[1]
        self.times, self.angle = constant(time), constant(source.angle)
        self.mean, self.std = constant(source.latent_mean), constant(source.latent_std)
        without = torch.tensor([0.0, 1.0, 0.0, 1.0, 0.0])  # which tokens belong to the part without the text
        self.apart = constant((without[:, None] - without).abs()[None, None] * MASKED)

    def forward(self, latent: Tensor, timestep: Tensor, text_latent: Tensor, guidance: Tensor) -> tuple[Tensor, Tensor]:
        """(B, d), (B,) int64, (B, d), (B,) -> (B, d) normalised and raw."""
        angle = self.angle[timestep][:, None]
        start, time = self.read_latent(latent)[:, None], self.times[timestep][:, None]
        x = torch.cat((start, start, time, time, self.read_text(text_latent)[:, None]), dim=1)
        x = self._hidden(x)
        hidden = x[:, 1] + guidance[:, None] * (x[:, 0] - x[:, 1])
        clean = angle.cos() * latent + angle.sin() * self.out(hidden)
        return clean, clean * self.std + self.mean

    def _hidden(self, x: Tensor) -> Tensor:
        """The latent's tokens (B, 2, d), with and without the text."""
        early, half, last = list[Tensor](), len(self.skips), len(self.layers) - 1
        for index, layer in enumerate(self.layers):
            if index > half:
                x = self.skips[index - half - 1](torch.cat((x, early.pop()), dim=2))
            x = layer(x, self.apart if index < last else self.apart[:, :, :2])
            if index < half:
                early.append(x)
        return x
