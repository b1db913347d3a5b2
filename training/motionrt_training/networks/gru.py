"""The rival of TMR's tables 1 and 2 in kind: co-embedding by recurrent networks, after Guo et al. 2022.

There, convolutions shorten the motion to snippets, bidirectional GRUs read snippets and words, and a margin loss
pulls pairs together. Here the convolutions are trained with the rest, words are the token features of the frozen
backbone, and vectors have unit length, so that distances rank as cosines do.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor, nn

from motionrt_training.networks.actor import Distribution
from motionrt_training.networks.transformer import Dropout

SURE = -20.0  # log variance: latents of this encoder are points


class GruEncoder(nn.Module):
    """Sequence -> point, by a bidirectional GRU over tokens, each of 2 ** `halvings` frames."""

    def __init__(self, in_dim: int, d: int = 256, hidden: int = 384, dropout: float = 0.1, halvings: int = 0) -> None:
        super().__init__()
        widths = [in_dim, *[hidden] * halvings]
        self.shorter = nn.ModuleList(
            nn.Conv1d(width, hidden, kernel_size=4, stride=2, padding=1) for width in widths[:halvings]
        )
        self.project = nn.Linear(widths[-1], hidden)
        self.gru = nn.GRU(hidden, hidden, batch_first=True, bidirectional=True)
        self.head = nn.Sequential(nn.Linear(2 * hidden, hidden), nn.LayerNorm(hidden), nn.LeakyReLU(0.2))
        self.out = nn.Linear(hidden, d)
        self.drop = Dropout(dropout)

    def forward(self, x: Tensor, mask: Tensor) -> Distribution:
        """Read x (B, F, in_dim), mask (B, F) bool, True where valid -> mu (B, d) of unit length, logvar (B, d)."""
        with torch.autocast(x.device.type, enabled=False):
            x = x.float() * mask[..., None]
            length = last_valid(mask)
            for layer in self.shorter:
                even = F.pad(x, (0, 0, 0, x.shape[1] % 2))
                length = (length + 1) // 2
                x = self.drop(F.leaky_relu(layer(even.mT), 0.2).mT)
                x = x * (torch.arange(x.shape[1], device=x.device) < length[:, None])[..., None]
            tokens = self.drop(F.leaky_relu(self.project(x), 0.2))
            packed = nn.utils.rnn.pack_padded_sequence(tokens, length.cpu(), batch_first=True, enforce_sorted=False)
            _, ends = self.gru(packed)  # (2, B, hidden): the last state of either direction
            mu = F.normalize(self.out(self.head(torch.cat((ends[0], ends[1]), dim=-1))), dim=-1)
        return Distribution(mu, torch.full_like(mu, SURE))


def last_valid(mask: Tensor) -> Tensor:
    """(B, F) bool -> (B,) the number of frames up to the last valid one, at least 1."""
    places = torch.arange(1, mask.shape[1] + 1, device=mask.device)
    return (mask * places).amax(1).clamp(min=1)
