"""What the denoiser's estimates are measured by: the features themselves, speeds, where it gets, and feet."""

from __future__ import annotations

import torch
from torch import Tensor

from motionrt.motion.features import ego77

ROOT_WEIGHT = 3.0
STILL = 0.3  # m/s: a foot that is slower counts as standing
SURE = 30.0  # frames after which a way counts half: the longer it is, the less of it noise lets see
FEET = [ego77.column(joint) for joint in ego77.FEET]


def motion_losses(
    found: Tensor, wanted: Tensor, std: Tensor, mean: Tensor, frames: Tensor, weight: Tensor
) -> dict[str, Tensor]:
    """Losses of normalised estimates (B, F, 77), frames (B, F) bool, weight (B,) of each
    motion, of which what follows from the features takes the root.

    "features": squared error; "speed": of joints in the body's axes, (m/s)^2; "way": of the heading and place that the
    root's ways add up to, radians and metres squared, long ways less; "feet": of the speed of feet over the ground,
    those that stand counting more.
    """
    there = frames.to(found.dtype)
    both = there[:, 1:] * there[:, :-1]
    channels = torch.ones_like(std)
    channels[ego77.ROOT] = ROOT_WEIGHT
    error = ((found - wanted).square() * channels).mean(-1)
    off = (found - wanted) * std
    speed = (off[:, 1:, 3:73] - off[:, :-1, 3:73]) * ego77.FPS
    way = (off[..., :3] * there[..., None]).cumsum(1)
    sure = 1 / (1 + (torch.arange(way.shape[1], device=way.device) / SURE).square())
    raw, true = found * std + mean, wanted * std + mean
    feet, true_feet = _foot_speeds(raw), _foot_speeds(true)
    still = torch.exp(-(true_feet.square().sum(-1, keepdim=True) / STILL**2))
    slip = ((feet - true_feet).square() * (0.3 + 2 * still)).mean((-1, -2))
    terms = {
        "features": _mean(error, there, weight),
        "speed": _mean(speed.square().mean(-1), both, weight.sqrt()),
        "way": _mean((way[..., 0].square() + 0.5 * way[..., 1:].square().sum(-1)) * sure, there, weight.sqrt()),
        "feet": _mean(slip, both, weight.sqrt()),
    }
    loss = terms["features"] + 0.25 * terms["speed"] + 0.15 * terms["way"] + 0.1 * terms["feet"]
    return {"loss": loss, **terms}


def _mean(values: Tensor, there: Tensor, weight: Tensor) -> Tensor:
    return (values * there * weight[:, None]).sum() / there.sum()


def _foot_speeds(raw: Tensor) -> Tensor:
    """(B, F - 1, 4, 3) speeds of ankles and feet over the ground, m/s, in the axes of the first of two frames."""
    now, then = raw[:, :-1], raw[:, 1:]
    turn, left, forward = now[..., 0], now[..., 1], now[..., 2]
    each = []
    for column in FEET:
        x, y, z = (now[..., column + k] for k in range(3))
        x2, y2, z2 = (then[..., column + k] for k in range(3))
        each.append(torch.stack([x2 - x + left + turn * z, y2 - y, z2 - z + forward - turn * x], dim=-1))
    return torch.stack(each, dim=-2) * ego77.FPS
