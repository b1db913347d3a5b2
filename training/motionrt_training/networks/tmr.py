"""TMR: text and motion encoders into one space, and a motion decoder out of it (Petrovich et al. 2023).

`encoder="gru"` is the rival of its tables 1 and 2 in kind, recurrent encoders of Guo et al. 2022; it is only compared.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from motionrt_training.networks.actor import ActorDecoder, ActorEncoder, Distribution
from motionrt_training.networks.gru import GruEncoder


class TMR(nn.Module):
    """The three networks with the statistics of the features, so that callers speak raw guo263 at 20 fps."""

    motion_mean: Tensor  # (motion_dim,)
    motion_std: Tensor  # (motion_dim,)

    def __init__(
        self,
        text_dim: int = 384,
        motion_dim: int = 263,
        d: int = 256,
        layers: int = 6,
        heads: int = 4,
        ff: int = 1024,
        dropout: float = 0.1,
        patch: int = 1,
        decoder_layers: int | None = None,
        slots: Sequence[int] = (),
        *,
        encoder: str = "transformer",
    ) -> None:
        super().__init__()
        gru = encoder == "gru"
        self.config = {
            "text_dim": text_dim,
            "motion_dim": motion_dim,
            "d": d,
            "layers": layers,
            "heads": heads,
            "ff": ff,
            "dropout": dropout,
            "patch": patch,
            "decoder_layers": decoder_layers or layers,
            "slots": list(slots),
            **({"encoder": encoder} if gru else {}),
        }
        sizes = (d, layers, heads, ff, dropout)
        self.text_encoder = GruEncoder(text_dim, d, dropout=dropout) if gru else ActorEncoder(text_dim, *sizes)
        self.motion_encoder = (
            GruEncoder(motion_dim, d, dropout=dropout, halvings=2) if gru else ActorEncoder(motion_dim, *sizes, patch)
        )
        self.motion_decoder = ActorDecoder(motion_dim, d, decoder_layers or layers, heads, ff, dropout, patch)
        self.slots = nn.Linear(d, sum(slots)) if slots else None  # what either latent says of each slot of motion
        self.register_buffer("motion_mean", torch.zeros(motion_dim))
        self.register_buffer("motion_std", torch.ones(motion_dim))

    def forward(
        self, tokens: Tensor, token_mask: Tensor, motion: Tensor, mask: Tensor
    ) -> tuple[Distribution, Distribution]:
        """Normalised motion (B, F, 263) and token features (B, T, 384) with bool masks -> text, motion."""
        return self.text_encoder(tokens, token_mask), self.motion_encoder(motion, mask)

    def normalise(self, motion: Tensor) -> Tensor:
        """Raw features -> zero mean, unit variance over the training split."""
        return (motion - self.motion_mean) / self.motion_std

    def denormalise(self, motion: Tensor) -> Tensor:
        """The inverse of `normalise`."""
        return motion * self.motion_std + self.motion_mean

    def encode_text(self, tokens: Tensor, mask: Tensor) -> Distribution:
        """Token features (B, T, 384), mask (B, T) -> Distribution; the direction of `mu` is the embedding."""
        return self.text_encoder(tokens, mask.to(torch.bool))

    def encode_motion(self, motion: Tensor, mask: Tensor) -> Distribution:
        """Raw guo263 (B, F, 263) at 20 fps, mask (B, F) -> Distribution."""
        return self.motion_encoder(self.normalise(motion), mask.to(torch.bool))

    def decode(self, latent: Tensor, mask: Tensor) -> Tensor:
        """Latent (B, d), mask (B, F) -> raw guo263 (B, F, 263), zeros where the mask is False."""
        mask = mask.to(torch.bool)
        return self.denormalise(self.motion_decoder(latent, mask)) * mask[..., None]
