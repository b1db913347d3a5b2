"""TEMOS (Petrovich et al. 2022) as SINC uses it: a variational autoencoder of motion whose latents text predicts, too.

What is this project's own: the networks see `networks.egocentric` frames instead of `sinc135`, `patch` frames to a
token; and around the transformers of the motion runs a linear path, from all tokens to the latent and back, which they
refine. A linear autoencoder learns in minutes what a transformer with distribution tokens alone takes days to find:
where in time things happen.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training.networks.actor import FIRST_LOGVAR, ActorEncoder, Distribution, patched
from motionrt_training.networks.egocentric import WIDTH, from_egocentric, to_egocentric
from motionrt_training.networks.transformer import Dropout, ResidualLayer, key_bias, sinusoidal_positions

MOTION_DIM = 135
LONGEST = 300  # frames


class TemosEncoder(nn.Module):
    """Frames -> Distribution, read from two tokens that begin as a linear function of all frames."""

    def __init__(self, d: int, layers: int, heads: int, ff: int, dropout: float, patch: int) -> None:
        super().__init__()
        self.d, self.patch, self.most = d, patch, -(-LONGEST // patch)
        self.project = nn.Linear(WIDTH * patch, d)
        self.gather = nn.Linear(self.most * d, 2 * d)
        self.layers = nn.ModuleList(ResidualLayer(d, heads, ff, dropout) for _ in range(layers))
        self.drop = Dropout(dropout)

    def forward(self, frames: Tensor, mask: Tensor) -> Distribution:
        """Read normalised frames (B, F, 136), F <= 300, mask (B, F) -> mu and logvar (B, d)."""
        x, mask = patched(frames, mask, self.patch)
        x = self.project(x) * mask[..., None].to(x.dtype)  # (B, T, d)
        summary = self.gather(F.pad(x, (0, 0, 0, self.most - x.shape[1])).flatten(1)).unflatten(1, (2, self.d))
        x = self.drop(x + sinusoidal_positions(x.shape[1], self.d, x))
        x = torch.cat((summary.to(x.dtype), x), dim=1)
        bias = key_bias(F.pad(mask, (2, 0), value=True), x.dtype)
        for layer in self.layers:
            x = layer(x, bias)
        return Distribution(x[:, 0].float(), bounded_logvar(x[:, 1].float()))


def bounded_logvar(x: Tensor) -> Tensor:
    """Within 3 of `FIRST_LOGVAR`: a variance that vanishes would make the KL terms drown all else."""
    return FIRST_LOGVAR + 3.0 * (x / 3.0).tanh()


class TemosDecoder(nn.Module):
    """Latent -> frames: the queries of all positions are linear in the latent, every layer attends to it again."""

    def __init__(self, d: int, layers: int, heads: int, ff: int, dropout: float, patch: int) -> None:
        super().__init__()
        self.d, self.patch, self.most = d, patch, -(-LONGEST // patch)
        self.spread = nn.Linear(d, self.most * d)
        self.layers = nn.ModuleList(ResidualLayer(d, heads, ff, dropout, latent=True) for _ in range(layers))
        self.project = nn.Linear(d, WIDTH * patch)
        self.drop = Dropout(dropout)

    def forward(self, latent: Tensor, mask: Tensor) -> Tensor:
        """Latent (B, d), mask (B, F), F <= 300 -> normalised frames (B, F, 136)."""
        valid = mask[:, :: self.patch]  # (B, T)
        x = self.spread(latent).unflatten(1, (self.most, self.d))[:, : valid.shape[1]]
        x = self.drop(x + sinusoidal_positions(x.shape[1], self.d, x))
        bias = key_bias(valid, x.dtype)
        for layer in self.layers:
            x = layer(x, bias, latent)
        frames = self.project(x).unflatten(-1, (self.patch, WIDTH)).flatten(1, 2)  # (B, T*patch, 136)
        return frames[:, : mask.shape[1]].float()


class Temos(nn.Module):
    """Text encoder, motion encoder and decoder with the statistics of the frames: callers speak raw sinc135, 30 fps."""

    frame_mean: Tensor  # (136,)
    frame_std: Tensor  # (136,)

    def __init__(
        self,
        text_dim: int = 384,
        motion_dim: int = MOTION_DIM,
        d: int = 256,
        layers: int = 6,
        heads: int = 4,
        ff: int = 1024,
        dropout: float = 0.1,
        patch: int = 8,
        separation: bool = False,
    ) -> None:
        super().__init__()
        if motion_dim != MOTION_DIM:
            raise ValueError(f"Temos speaks sinc135, not features of width {motion_dim}")
        self.config = {
            "text_dim": text_dim,
            "motion_dim": motion_dim,
            "d": d,
            "layers": layers,
            "heads": heads,
            "ff": ff,
            "dropout": dropout,
            "patch": patch,
        }
        if separation:  # only then, so that networks without it keep their form
            self.config["separation"] = True
            self.separator = nn.Parameter(0.02 * torch.randn(text_dim))
        self.text_encoder = ActorEncoder(text_dim, d, layers, heads, ff, dropout)
        self.text_mu = nn.Linear(d, d)  # the latent has a scale of its own
        self.motion_encoder = TemosEncoder(d, layers, heads, ff, dropout, patch)
        self.motion_decoder = TemosDecoder(d, layers, heads, ff, dropout, patch)
        self.register_buffer("frame_mean", torch.zeros(WIDTH))
        self.register_buffer("frame_std", torch.ones(WIDTH))

    def forward(
        self, tokens: Tensor, token_mask: Tensor, frames: Tensor, mask: Tensor
    ) -> tuple[Distribution, Distribution]:
        """Token features (B, T, 384) and normalised frames (B, F, 136) with bool masks -> text, motion."""
        return self.encode_text(tokens, token_mask), self.motion_encoder(frames, mask)

    def normalise(self, frames: Tensor) -> Tensor:
        """Egocentric frames -> zero mean, unit variance over the training split."""
        return (frames - self.frame_mean) / self.frame_std

    def denormalise(self, frames: Tensor) -> Tensor:
        """The inverse of `normalise`."""
        return frames * self.frame_std + self.frame_mean

    def encode_text(self, tokens: Tensor, mask: Tensor) -> Distribution:
        """Token features (B, T, 384), mask (B, T) -> Distribution of latents (B, d).

        With a separation token, rows of zeros within the mask are where it stands: between separately encoded texts.
        """
        if "separation" in self.config:
            tokens = torch.where((tokens == 0).all(-1, keepdim=True), self.separator.to(tokens.dtype), tokens)
        mu, logvar = self.text_encoder(tokens, mask.to(torch.bool))
        return Distribution(self.text_mu(mu).float(), logvar)

    def encode_motion(self, motion: Tensor, mask: Tensor) -> Distribution:
        """Raw sinc135 (B, F, 135) at 30 fps, mask (B, F) -> Distribution of latents (B, d)."""
        mask = mask.to(torch.bool)
        goes_on = mask & F.pad(mask[:, 1:], (0, 1))  # no rate at the last frame: behind it stands nothing
        frames = to_egocentric(motion)
        rates = frames[..., :3] * goes_on[..., None]
        return self.motion_encoder(self.normalise(torch.cat((rates, frames[..., 3:]), dim=-1)), mask)

    def decode(self, latent: Tensor, mask: Tensor) -> Tensor:
        """Latent (B, d), mask (B, F) -> raw sinc135 (B, F, 135) from the origin on, zeros where the mask is False."""
        mask = mask.to(torch.bool)
        return from_egocentric(self.denormalise(self.motion_decoder(latent, mask))) * mask[..., None]
