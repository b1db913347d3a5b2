"""The denoiser of latent diffusion: a noisy TEMOS latent and a text -> the clean latent (MLD, Chen et al. 2023, 3.2).

A text is a sequence of tokens; the shipped network is given one, the mean of the text's latent.

The schedule and the sampling loop are `motionrt.synthesis.diffusion`. Noisy and clean latents are normalised, so that
pure noise is standard normal; the statistics are inside, and the answer comes in both units.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt.motion.skeleton import FloatArray
from motionrt.synthesis.diffusion import ddim, schedule
from motionrt.synthesis.sampling import GUIDANCE, STEPS
from motionrt_training.networks.transformer import Dropout, EncoderLayer, key_bias, sinusoidal_positions

WAVES = 16  # sines and cosines of the time's angle


class LatentDenoiser(nn.Module):
    """Transformer encoder over [latent, time, text tokens] with skip connections between early and late layers.

    A time step is told by its angle p, cos p = sqrt(a_t) the part of the signal and sin p that of the noise. The
    answer is sqrt(a_t) z_t, the best guess where nothing but the variance is known, plus sin p times what the
    network adds: an untrained network gives the guess alone. Without a text the text's tokens are hidden.
    """

    latent_mean: Tensor  # (latent,) of the raw latents in training
    latent_std: Tensor  # (latent,)
    angle: Tensor  # (1000,) of every time step, radians

    def __init__(
        self,
        text_dim: int = 256,
        latent: int = 256,
        d: int = 256,
        layers: int = 5,
        heads: int = 4,
        ff: int = 1024,
        dropout: float = 0.1,
    ) -> None:
        super().__init__()
        if layers % 2 == 0:
            raise ValueError(f"skip connections join layers around a middle one: layers must be odd, not {layers}")
        sizes = {"text_dim": text_dim, "latent": latent, "d": d, "layers": layers, "heads": heads, "ff": ff}
        self.config = {**sizes, "dropout": dropout}
        self.d = d
        self.read_latent, self.read_text = nn.Linear(latent, d), nn.Linear(text_dim, d)
        self.read_time = nn.Sequential(nn.Linear(2 * WAVES, d), nn.SiLU(), nn.Linear(d, d))
        self.layers = nn.ModuleList(EncoderLayer(d, heads, ff, dropout) for _ in range(layers))
        self.skips = nn.ModuleList(nn.Linear(2 * d, d) for _ in range(layers // 2))
        self.drop = Dropout(dropout)
        self.out = nn.Linear(d, latent)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)
        self.register_buffer("latent_mean", torch.zeros(latent))
        self.register_buffer("latent_std", torch.ones(latent))
        self.register_buffer("angle", torch.from_numpy(schedule()).sqrt().acos().float(), persistent=False)

    def forward(self, latent: Tensor, timestep: Tensor, tokens: Tensor, mask: Tensor) -> Tensor:
        """Estimate the clean latent (B, 256) from z_t (B, 256) and its text; both normalised.

        Args:
            latent: z_t (B, 256), normalised.
            timestep: (B,) int64 in [0, 1000).
            tokens: the text's tokens (B, T, text_dim).
            mask: (B, T), True or 1 where there is a token; a row without any is without text.
        """
        angle = self.angle[timestep][:, None]  # (B, 1)
        x = self._tokens(latent, angle, tokens)  # (B, 2 + T, d)
        shown = torch.cat((torch.ones_like(mask[:, :1]), torch.ones_like(mask[:, :1]), mask), dim=1)
        found = self.out(self._hidden(x, key_bias(shown.to(torch.bool), x.dtype)))
        return angle.cos() * latent + angle.sin() * found.float()

    def guided(
        self, latent: Tensor, timestep: Tensor, tokens: Tensor, mask: Tensor, guidance: Tensor
    ) -> tuple[Tensor, Tensor]:
        """Classifier-free guidance g (B,): without + g (with - without), from one batch of 2B (Ho & Salimans 2022).

        g = 0 ignores the text, 1 is `forward`, more exaggerates.

        Returns:
            The estimate of the clean latent (B, 256) normalised, and in the units of TEMOS.
        """
        masks = torch.cat((mask, torch.zeros_like(mask)))
        both = self(torch.cat((latent, latent)), torch.cat((timestep, timestep)), torch.cat((tokens, tokens)), masks)
        conditioned, without = both.chunk(2)
        clean = without + guidance[:, None] * (conditioned - without)
        return clean, self.denormalise(clean)

    def normalise(self, latent: Tensor) -> Tensor:
        """Raw TEMOS latents -> zero mean, unit variance over the training data."""
        return (latent - self.latent_mean) / self.latent_std

    def denormalise(self, latent: Tensor) -> Tensor:
        """The inverse of `normalise`."""
        return latent * self.latent_std + self.latent_mean

    def noised(self, clean: Tensor, timestep: Tensor, noise: Tensor) -> Tensor:
        """z_t (B, 256) of clean latents, normalised: sqrt(a_t) z_0 + sqrt(1 - a_t) e (Ho et al. 2020, eq. 4)."""
        angle = self.angle[timestep][:, None]
        return angle.cos() * clean + angle.sin() * noise

    def _tokens(self, latent: Tensor, angle: Tensor, tokens: Tensor) -> Tensor:
        waves = angle * torch.arange(1, WAVES + 1, device=angle.device)  # (B, 16)
        time = self.read_time(torch.cat((waves.sin(), waves.cos()), dim=1))
        x = torch.cat((self.read_latent(latent)[:, None], time[:, None], self.read_text(tokens)), dim=1)
        return self.drop(x + sinusoidal_positions(x.shape[1], self.d, x))

    def _hidden(self, x: Tensor, bias: Tensor) -> Tensor:
        """The latent's token (B, d) behind the last layer."""
        half, early = len(self.skips), list[Tensor]()
        for layer in self.layers[:half]:
            x = layer(x, bias)
            early.append(x)
        x = self.layers[half](x, bias)
        for skip, layer in zip(self.skips, self.layers[half + 1 :], strict=True):
            x = skip(torch.cat((x, early.pop()), dim=-1))
            x = _first_token(layer, x, bias) if self.training and not early else layer(x, bias)
        return x[:, 0]


def _first_token(layer: Any, x: Tensor, bias: Tensor) -> Tensor:
    """What an `EncoderLayer` makes of the first token, (B, 1, d): the others of the last layer are not read."""
    attention, d, first = layer.attention, x.shape[2], x[:, :1]
    weight, offset = attention.qkv.weight, attention.qkv.bias
    (q,) = attention.split(F.linear(first, weight[:d], offset[:d]), 1)
    k, v = attention.split(F.linear(x, weight[d:], offset[d:]), 2)
    first = layer.norm1(first + layer.drop(attention.out(attention.join(attention.explicit(q, k, v, bias)))))
    return layer.norm2(first + layer.drop(layer.feed(first)))


@torch.no_grad()
def draw_latents(
    model: LatentDenoiser, tokens: Tensor, mask: Tensor, noise: Tensor, steps: int = STEPS, guidance: float = GUIDANCE
) -> Tensor:
    """Raw TEMOS latents (B, 256) of texts (B, T, text_dim) with mask (B, T), by DDIM from normal noise (B, 256)."""
    strength = torch.full((len(noise),), guidance, device=noise.device)

    def denoise(latent: FloatArray, timestep: npt.NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
        seen, time = (torch.from_numpy(part).to(noise.device) for part in (latent, timestep))
        clean, raw = model.guided(seen, time, tokens, mask, strength)
        return clean.cpu().numpy(), raw.cpu().numpy()

    return torch.from_numpy(ddim(denoise, noise.cpu().numpy(), steps)).to(noise.device)
