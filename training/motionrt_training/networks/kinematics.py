"""Forward kinematics of `smpl24` and the way back to rotations, in torch."""

from __future__ import annotations

from typing import cast

import torch
from torch import Tensor

from motionrt.motion import SMPL24


def joint_positions(rotations: Tensor, root: Tensor | None = None) -> Tensor:
    """Local rotations (..., 24, 3, 3) and pelvis (..., 3), by default the origin -> joints (..., 24, 3), metres."""
    offsets = torch.from_numpy(SMPL24.offsets.copy()).to(rotations)
    turned = [rotations[..., 0, :, :]]
    places = [torch.zeros_like(rotations[..., 0, :, 0]) if root is None else root]
    for joint, parent in enumerate(SMPL24.parents[1:], start=1):
        places.append(places[parent] + turned[parent] @ offsets[joint])
        turned.append(turned[parent] @ rotations[..., joint, :, :])
    return torch.stack(places, dim=-2)


def product(a: Tensor, b: Tensor) -> Tensor:
    """Products of 3x3 matrices, element by element: faster on a CPU than a batched matmul, float32 under autocast."""
    return cast("Tensor", sum(a[..., :, i, None] * b[..., None, i, :] for i in range(3)))


def nearer_so3(matrices: Tensor) -> Tensor:
    """One Newton-Schulz step of the polar decomposition, ``M (3 - M^T M) / 2``, on (..., 3, 3)."""
    gram = product(matrices.transpose(-1, -2), matrices)
    return product(matrices, 1.5 * torch.eye(3, device=matrices.device) - 0.5 * gram)
