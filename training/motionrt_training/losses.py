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
    """InfoNCE in both directions (TMR eq. 1), mean of the two.

    `keep` (B, B) bool: False drops a pair from both denominators; the diagonal is always kept.
    """
    logits = cosine_matrix(text, motion) / temperature
    if keep is not None:
        own = torch.eye(len(logits), dtype=torch.bool, device=logits.device)
        logits = logits.masked_fill(~(keep | own), float("-inf"))
    target = torch.arange(len(logits), device=logits.device)
    return 0.5 * (F.cross_entropy(logits, target) + F.cross_entropy(logits.T, target))


def paired_nce(text: Tensor, motion: Tensor, positive: Tensor, negative: Tensor, temperature: float = 0.1) -> Tensor:
    """InfoNCE (TMR eq. 1) where a text may have several motions, as a clip and its mirror image with one caption.

    text (T, d), motion (M, d); `positive` (T, M) bool: the pairs; `negative` (T, M): 0 drops a pair from both
    denominators, a weight above 1 counts it as so many negatives. Every pair is told from the negatives of its text,
    and from those of its motion; other pairs of the same text or motion stay out. The mean over all pairs.
    """
    logits = cosine_matrix(text, motion) / temperature
    against = logits + negative.clamp(min=1e-30).log()
    against = against.masked_fill(positive | (negative == 0), float("-inf"))
    own = logits[positive]
    rows, columns = positive.nonzero(as_tuple=True)
    by_text = F.softplus(against.logsumexp(1)[rows] - own)
    by_motion = F.softplus(against.logsumexp(0)[columns] - own)
    return 0.5 * (by_text.mean() + by_motion.mean())


def slot_loss(logits: Tensor, slots: Tensor, sizes: list[int]) -> Tensor:
    """Cross entropy of what is known of each slot: logits (N, sum of sizes), slots (N, S), 0 is unknown."""
    terms = [
        F.cross_entropy(part.float(), column - 1, ignore_index=-1, reduction="sum")
        for part, column in zip(logits.split(sizes, dim=1), slots.unbind(1), strict=True)
    ]
    return torch.stack(terms).sum() / (slots > 0).sum().clamp(min=1)


def margin_loss(text: Tensor, motion: Tensor, positive: Tensor, negative: Tensor, margin: float = 1.0) -> Tensor:
    """Contrastive margin loss on Euclidean distances of the latents (Hadsell et al. 2006; TMR table 3).

    Pairs `positive` (T, M) are pulled together (squared distance), `negative` ones (T, M) pushed beyond `margin`.
    """
    text, motion = text.float(), motion.float()
    squared = (text[:, None] - motion[None]).square().sum(-1)  # (T, M)
    push = (margin - (squared + 1e-12).sqrt()).clamp(min=0.0).square()
    return squared[positive].mean() + (push * negative).sum() / negative.sum().clamp(min=1)
