"""Where the feet of predicted frames are: forward kinematics of the legs in torch, float32 under autocast."""

from __future__ import annotations

import torch
from torch import Tensor

from motionrt.motion import SMPL24
from motionrt_training.networks.kinematics import product

LEGS = tuple(
    tuple(SMPL24.index(f"{side}_{joint}") for joint in ("hip", "knee", "ankle", "foot")) for side in ("left", "right")
)


def feet(frames: Tensor) -> Tensor:
    """`ccf219` frames (B, T, 219) -> ankles and toes (B, T, 2 sides, 2 joints, 3), metres."""
    with torch.autocast(frames.device.type, enabled=False):
        x = frames.float()
        offsets = x.new_tensor(SMPL24.offsets)[torch.tensor(LEGS)]  # (2, 4, 3)
        local = x[..., :216].unflatten(-1, (24, 3, 3))[..., torch.tensor([leg[:3] for leg in LEGS]), :, :]
        turn = x[..., :9].unflatten(-1, (3, 3))[..., None, :, :]  # (B, T, 1, 3, 3)
        place = x[..., None, 216:] + _rotated(turn, offsets[:, 0])  # hips (B, T, 2, 3)
        points = []
        for joint in range(3):
            turn = product(turn, local[..., joint, :, :])
            place = place + _rotated(turn, offsets[:, joint + 1])
            points.append(place)
        return torch.stack(points[1:], dim=-2)


def _rotated(turn: Tensor, offset: Tensor) -> Tensor:
    return (turn * offset[:, None, :]).sum(-1)
