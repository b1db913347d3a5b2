"""A variational autoencoder over one pose: 24 joint rotations, the pelvis without its yaw, in a small normal latent."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt.motion import SMPL24

JOINTS = len(SMPL24)


class PosePrior(nn.Module):
    """VPoser-like: 6D rotations -> MLP -> N(mu, sigma) over the latent -> MLP -> 6D -> Gram-Schmidt.

    The pelvis' tilt is part of the pose, because sitting, bending and lying are known by it; its yaw is not.
    """

    mean: Tensor  # (144,) of the 6D rotations in the training data
    std: Tensor  # (144,)

    def __init__(self, latent: int = 32, width: int = 512, dropout: float = 0.1) -> None:
        super().__init__()
        self.config = {"latent": latent, "width": width, "dropout": dropout}
        self.encoder = nn.Sequential(
            nn.Linear(6 * JOINTS, width),
            nn.SiLU(),
            nn.Dropout(dropout),
            nn.Linear(width, width),
            nn.SiLU(),
            nn.Linear(width, 2 * latent),
        )
        self.decoder = nn.Sequential(
            nn.Linear(latent, width),
            nn.SiLU(),
            nn.Linear(width, width),
            nn.SiLU(),
            nn.Linear(width, 6 * JOINTS),
        )
        self.register_buffer("mean", torch.zeros(6 * JOINTS))
        self.register_buffer("std", torch.ones(6 * JOINTS))

    def encode(self, rotations: Tensor) -> tuple[Tensor, Tensor]:
        """Rotations (B, 24, 3, 3) -> mu and logvar (B, latent)."""
        x = (to_6d(rotations).flatten(1) - self.mean) / self.std
        mu, logvar = self.encoder(x).chunk(2, dim=-1)
        return mu, logvar

    def decode(self, latent: Tensor) -> Tensor:
        """Latent (B, latent) -> rotations (B, 24, 3, 3) local to the parent."""
        sixd = self.decoder(latent) * self.std + self.mean
        return from_6d(sixd.unflatten(-1, (JOINTS, 6)))

    def forward(self, latent: Tensor) -> Tensor:
        """What is exported: `decode`."""
        return self.decode(latent)


def to_6d(rotations: Tensor) -> Tensor:
    """The first two columns: (..., 3, 3) -> (..., 6)."""
    return torch.cat((rotations[..., 0], rotations[..., 1]), dim=-1)


def from_6d(sixd: Tensor) -> Tensor:
    """Gram-Schmidt: (..., 6) -> (..., 3, 3)."""
    x = unit(sixd[..., :3])
    y = sixd[..., 3:]
    y = unit(y - (x * y).sum(-1, keepdim=True) * x)
    x0, x1, x2 = x.unbind(-1)
    y0, y1, y2 = y.unbind(-1)
    z = torch.stack((x1 * y2 - x2 * y1, x2 * y0 - x0 * y2, x0 * y1 - x1 * y0), dim=-1)
    return torch.stack((x, y, z), dim=-1)


def unit(x: Tensor) -> Tensor:
    """Length 1 along the last axis."""
    return x * (x * x).sum(-1, keepdim=True).clamp(min=1e-12).rsqrt()
