"""The losses of TMR (Petrovich et al. 2023, 3.2 and 3.3) and of its ablations (table 3), all in float32."""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor

from motionrt_training.networks.actor import Distribution


def reconstruction(predicted: Tensor, target: Tensor, mask: Tensor) -> Tensor:
    """Smooth-L1 of each motion, averaged over its valid frames: (B, F, D), (B, F, D), (B, F) -> (B,)."""
    error = F.smooth_l1_loss(predicted.float(), target.float(), reduction="none").mean(-1)  # (B, F)
    valid = mask.to(error.dtype)
    return (error * valid).sum(1) / valid.sum(1).clamp(min=1.0)


def kl_to_standard(q: Distribution) -> Tensor:
    """KL(q || N(0, 1)), mean over batch and dimensions."""
    mu, logvar = q.mu.float(), q.logvar.float()
    return 0.5 * (mu.square() + logvar.exp() - 1.0 - logvar).mean()


def kl_between(q: Distribution, p: Distribution) -> Tensor:
    """KL(q || p) of diagonal Gaussians, mean over batch and dimensions."""
    mu, logvar = q.mu.float() - p.mu.float(), q.logvar.float() - p.logvar.float()
    return 0.5 * (mu.square() * (-p.logvar.float()).exp() + logvar.exp() - 1.0 - logvar).mean()


def kl_terms(text: Distribution, motion: Distribution) -> Tensor:
    """The four terms of TEMOS: text || motion, motion || text, motion || N, text || N; their sum."""
    return kl_between(text, motion) + kl_between(motion, text) + kl_to_standard(motion) + kl_to_standard(text)


def latent_distance(text: Tensor, motion: Tensor) -> Tensor:
    """Smooth-L1 between the two latents (B, d)."""
    return F.smooth_l1_loss(text.float(), motion.float())


def cosine_matrix(text: Tensor, motion: Tensor) -> Tensor:
    """(B, d), (B, d) -> (B, B): row i is text i against every motion."""
    return F.normalize(text.float(), dim=-1) @ F.normalize(motion.float(), dim=-1).T


def info_nce(text: Tensor, motion: Tensor, keep: Tensor | None = None, temperature: float = 0.1) -> Tensor:
    """InfoNCE in both directions (TMR eq. 2), mean of the two.

    `keep` (B, B) bool: False drops a pair from both denominators; the diagonal is always kept.
    """
    logits = cosine_matrix(text, motion) / temperature
    if keep is not None:
        own = torch.eye(len(logits), dtype=torch.bool, device=logits.device)
        logits = logits.masked_fill(~(keep | own), float("-inf"))
    target = torch.arange(len(logits), device=logits.device)
    return 0.5 * (F.cross_entropy(logits, target) + F.cross_entropy(logits.T, target))


def margin_loss(text: Tensor, motion: Tensor, keep: Tensor | None = None, margin: float = 1.0) -> Tensor:
    """Contrastive margin loss on Euclidean distances of the latents (Hadsell et al. 2006; TMR table 3).

    Pairs are pulled together (squared distance), kept negatives pushed beyond `margin`.
    """
    text, motion = text.float(), motion.float()
    squared = (text[:, None] - motion[None]).square().sum(-1)  # (B, B)
    own = torch.eye(len(squared), dtype=torch.bool, device=squared.device)
    push = (margin - (squared + 1e-12).sqrt()).clamp(min=0.0).square()
    negative = ~own if keep is None else keep & ~own
    return squared[own].mean() + (push * negative).sum() / negative.sum().clamp(min=1)
