"""How the step decoder is trained: it goes on from the middle of motions, and then from what it said itself.

The history deviates a little from the truth, as its own will when it runs free; what is wanted then fades from where
the motion is to where it should be, so that errors are mended without a jump.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import torch
import torch.nn.functional as F
from torch import Tensor

from motionrt_training.networks.egocentric import RATES
from motionrt_training.networks.temos import AHEAD, HISTORY, StepDecoder

if TYPE_CHECKING:
    from motionrt_training.temos_task import TemosSettings

BEGINNINGS = 0.2  # part of the windows that begin at the start, without a history
JITTER = 0.03  # of single frames of the history, standard deviations


def continued(
    decoder: StepDecoder, latent: Tensor, frames: Tensor, mask: Tensor, settings: TemosSettings
) -> tuple[Tensor, Tensor, Tensor]:
    """Chains of predictions from random places of every motion.

    Args:
        decoder: the network.
        latent: (B, d).
        frames: normalised (B, F, 136).
        mask: (B, F), True where there is a frame.
        settings: how many windows, how many predictions in a row, how far the history deviates.

    Returns:
        Decoded, wanted (B * windows, chain * 8, 136), mask of both.
    """
    count, span = settings.windows, AHEAD * settings.chain
    first = starts(mask, count)  # (B, W)
    rows = torch.arange(len(frames), device=frames.device).repeat_interleave(count)
    truth, there = windows(frames, mask, rows, first.flatten(), span)
    history, wanted = drifted(truth[:, :HISTORY], settings.drift), truth[:, HISTORY:]
    known = there[:, HISTORY - 1].float()  # at the start there is nothing to go on from
    modulation = decoder.modulation(latent)[rows]
    time, last_truth, said, targets = first.flatten().float(), truth[:, HISTORY - 1], [], []
    for index in range(settings.chain):
        part = wanted[:, index * AHEAD : (index + 1) * AHEAD]
        targets.append(faded(part, (history[:, -1].detach() - last_truth) * known[:, None]))
        said.append(decoder.step(history, time + index * AHEAD, modulation))
        history = torch.cat((history, said[-1].to(history.dtype)), dim=1)[:, -HISTORY:]
        known = torch.ones_like(known)
        last_truth = part[:, -1]
    return torch.cat(said, dim=1), torch.cat(targets, dim=1), there[:, HISTORY:]


def starts(mask: Tensor, count: int) -> Tensor:
    """Random first frames (B, count) to be predicted; some are the very first."""
    length = mask.sum(1, keepdim=True)
    pick = torch.rand(len(mask), count, device=mask.device)
    first = (pick * (length - AHEAD).clamp(min=0)).long()
    return torch.where(torch.rand_like(pick) < BEGINNINGS, torch.zeros_like(first), first)


def windows(frames: Tensor, mask: Tensor, rows: Tensor, first: Tensor, span: int) -> tuple[Tensor, Tensor]:
    """(N, 16 + span, 136) frames around `first` of motions `rows`, and where there are any."""
    padded, valid = F.pad(frames, (0, 0, HISTORY, span)), F.pad(mask, (HISTORY, span))
    at = first[:, None] + torch.arange(HISTORY + span, device=first.device)
    return padded[rows[:, None], at], valid[rows[:, None], at]


def drifted(history: Tensor, largest: float) -> Tensor:
    """A history (N, 16, 136) that has drifted: off by a constant, up to `largest`, and a little by frame."""
    off = largest * torch.rand_like(history[:, :1, :1]) * torch.randn_like(history[:, :1])
    return history + off + JITTER * torch.randn_like(history)


def faded(wanted: Tensor, error: Tensor) -> Tensor:
    """Frames (N, 8, 136) approached from where the last one was off by `error` (N, 136); rates are wanted at once."""
    weight = 1.0 - torch.arange(1, AHEAD + 1, device=wanted.device) / AHEAD
    change = error[:, None] * weight[:, None]
    return torch.cat((wanted[..., RATES], wanted[..., RATES.stop :] + change[..., RATES.stop :]), dim=-1)
