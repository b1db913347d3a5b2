"""The modules as they are exported: what each use needs and no more, with the normalisation inside."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt_export.layers import Decoder, Encoder, constant, folded
from motionrt_training.networks.actor import FIRST_LOGVAR, ActorDecoder, ActorEncoder, patched
from motionrt_training.networks.minilm import MiniLM, mean_pooled
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transformer import key_bias, sinusoidal_positions


def unit(x: Tensor) -> Tensor:
    """Rows of (B, d) at length 1; a zero row stays zero."""
    return x / x.norm(dim=-1, keepdim=True).clamp(min=1e-12)


class SentenceEncoderGraph(nn.Module):
    """Token features and the pooled sentence embedding in one pass."""

    def __init__(self, backbone: MiniLM) -> None:
        super().__init__()
        self.words = backbone.words
        self.positions = nn.Parameter(backbone.positions + backbone.segment, requires_grad=False)
        self.norm = backbone.norm
        self.layers = nn.ModuleList(Encoder(layer) for layer in backbone.layers)

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> tuple[Tensor, Tensor]:
        """(B, T), (B, T) int64 -> (B, T, 384), (B, 384)."""
        x = self.norm(self.words(input_ids) + self.positions[: input_ids.shape[1]])
        bias = key_bias(attention_mask.to(torch.bool))
        for layer in self.layers:
            x = layer(x, bias)
        return x, mean_pooled(x, attention_mask)


class ActorAnswers(nn.Module):
    """An `ActorEncoder` whose last layer answers for the tokens that are read: the mean's, or the logvar's as well."""

    def __init__(self, source: ActorEncoder, *, read: int) -> None:
        super().__init__()
        self.d, self.patch = source.d, source.patch
        self.project, self.tokens = source.project, source.tokens
        last = len(source.layers) - 1
        self.layers = nn.ModuleList(
            Encoder(layer, first=read if index == last else None) for index, layer in enumerate(source.layers)
        )

    def answers(self, x: Tensor, mask: Tensor) -> Tensor:
        """X (B, F, in_dim), mask (B, F) bool -> (B, read, d)."""
        x, mask = patched(x, mask, self.patch)
        x = torch.cat((self.tokens.expand(x.shape[0], -1, -1), self.project(x)), dim=1)
        x = x + sinusoidal_positions(x.shape[1], self.d, x)
        always = torch.ones_like(mask[:, :1])
        bias = key_bias(torch.cat((always, always, mask), dim=1))
        for layer in self.layers:
            x = layer(x, bias)
        return x


class ActorEncoderGraph(ActorAnswers):
    """The mean of an `ActorEncoder`."""

    def __init__(self, source: ActorEncoder) -> None:
        super().__init__(source, read=1)

    def forward(self, x: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
        """X (B, F, in_dim), mask (B, F) bool -> embedding and latent (B, d)."""
        latent = self.answers(x, mask)[:, 0]
        return unit(latent), latent


class DistributionGraph(ActorAnswers):
    """Mean and logvar of an `ActorEncoder`."""

    def __init__(self, source: ActorEncoder) -> None:
        super().__init__(source, read=2)

    def forward(self, x: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
        """X (B, F, in_dim), mask (B, F) bool -> mu and logvar (B, d)."""
        x = self.answers(x, mask)
        return x[:, 0], x[:, 1] + FIRST_LOGVAR


class TextGraph(nn.Module):
    """Tokens -> embedding and latent, by way of the sentence encoder, whose features and embedding are there, too.

    Who asks for the last two alone pays for no more: the runtime computes what leads to the outputs that are fetched.
    """

    def __init__(self, backbone: MiniLM, model: TMR) -> None:
        super().__init__()
        self.sentences = SentenceEncoderGraph(backbone)
        self.encoder = ActorEncoderGraph(model.text_encoder)

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        """(B, T), (B, T) int64 -> (B, d), (B, d), (B, T, 384), (B, 384)."""
        features, sentence = self.sentences(input_ids, attention_mask)
        embedding, latent = self.encoder(features, attention_mask.to(torch.bool))
        return embedding, latent, features, sentence


class StudentGraph(nn.Module):
    """Tokens -> embedding, and the vector in its direction, by the small text tower.

    The way from the word vectors into the first layer is linear, so it is looked up: one table of what enters, where
    that is no larger than the word vectors.
    """

    def __init__(self, source: TextStudent) -> None:
        super().__init__()
        enter = source.enter
        looked_up = enter.out_features <= enter.in_features
        self.words = nn.Embedding.from_pretrained(_entering(source) if looked_up else source.words.weight.detach())
        self.enter = nn.Identity() if looked_up else enter
        self.positions = constant(source.positions)
        self.norm = source.norm
        self.layers = nn.ModuleList(Encoder(layer) for layer in source.layers)
        self.leave = source.leave

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> tuple[Tensor, Tensor]:
        """(B, T), (B, T) int64 -> (B, d), (B, d)."""
        x = self.norm(self.enter(self.words(input_ids)) + self.positions[: input_ids.shape[1]])
        bias = key_bias(attention_mask.to(torch.bool))
        for layer in self.layers:
            x = layer(x, bias)
        weight = attention_mask.to(x.dtype)[..., None]
        latent = self.leave((x * weight).sum(1) / weight.sum(1))
        return unit(latent), latent


@torch.no_grad()
def _entering(source: TextStudent) -> Tensor:
    """What enters the first layer of every word (vocabulary, d), before its position."""
    return source.enter(source.words.weight)


class MotionEncoderGraph(nn.Module):
    """Raw guo263 features -> embedding and latent."""

    def __init__(self, model: TMR) -> None:
        super().__init__()
        self.encoder = ActorEncoderGraph(model.motion_encoder)
        self.mean = nn.Parameter(model.motion_mean.clone(), requires_grad=False)
        self.rate = nn.Parameter(1.0 / model.motion_std, requires_grad=False)

    def forward(self, motion: Tensor, mask: Tensor) -> tuple[Tensor, Tensor]:
        """(B, F, 263), (B, F) bool -> (B, d), (B, d)."""
        return self.encoder((motion - self.mean) * self.rate, mask)


class DecoderGraph(nn.Module):
    """Latent -> raw guo263 features; the attention of all layers to the one latent is a single Linear."""

    def __init__(self, model: TMR) -> None:
        super().__init__()
        source: ActorDecoder = model.motion_decoder
        self.d, self.patch, self.out_dim = source.d, source.patch, source.out_dim
        self.hear = folded([layer.cross for layer in source.layers])
        self.layers = nn.ModuleList(Decoder(layer) for layer in source.layers)
        self.project = source.project
        self.mean, self.std = model.motion_mean, model.motion_std

    def forward(self, latent: Tensor, mask: Tensor) -> Tensor:
        """(B, d), (B, F) bool -> (B, F, 263), zeros where the mask is False."""
        valid = mask[:, :: self.patch]  # (B, T)
        bias = key_bias(valid)
        heard = self.hear(latent[:, None]).split(self.d, dim=-1)
        x = sinusoidal_positions(valid.shape[1], self.d, latent).expand(latent.shape[0], -1, -1)
        for layer, part in zip(self.layers, heard, strict=True):
            x = layer(x, part, bias)
        frames = self.project(x).view(latent.shape[0], -1, self.out_dim)[:, : mask.shape[1]]
        return (frames * self.std + self.mean) * mask[..., None]
