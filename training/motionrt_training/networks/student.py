"""A text tower that costs little: word vectors and a few small layers that give the embedding of a large one."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.transformer import EncoderLayer, key_bias


class TextStudent(nn.Module):
    """Token ids -> latent whose direction is the text's embedding; the mean of what the last layer says of its tokens.

    The word vectors are those of the sentence encoder in as many directions as `words` says, and stay as they are, so
    that words which training never saw keep their place beside those that it did.
    """

    def __init__(
        self,
        vocabulary: int = 30522,
        words: int = 256,
        d: int = 256,
        layers: int = 3,
        heads: int = 4,
        ff: int = 512,
        out: int = 256,
        dropout: float = 0.0,
        longest: int = 128,
    ) -> None:
        super().__init__()
        self.config = {
            "vocabulary": vocabulary, "words": words, "d": d, "layers": layers, "heads": heads, "ff": ff, "out": out,
            "dropout": dropout, "longest": longest,
        }  # fmt: skip
        self.words = nn.Embedding(vocabulary, words)
        self.words.weight.requires_grad_(False)
        self.enter = nn.Linear(words, d)
        self.positions = nn.Parameter(torch.randn(longest, d) * 0.02)
        self.norm = nn.LayerNorm(d)
        self.layers = nn.ModuleList(EncoderLayer(d, heads, ff, dropout) for _ in range(layers))
        self.leave = nn.Linear(d, out)

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> Tensor:
        """(B, T), (B, T) int64 -> (B, out)."""
        x = self.norm(self.enter(self.words(input_ids)) + self.positions[: input_ids.shape[1]])
        bias = key_bias(attention_mask.to(torch.bool))
        for layer in self.layers:
            x = layer(x, bias)
        weight = attention_mask.to(x.dtype)[..., None]
        return self.leave((x * weight).sum(1) / weight.sum(1))

    @torch.no_grad()
    def take_words(self, backbone: MiniLM) -> None:
        """The word vectors of the sentence encoder along their principal directions, scaled to unit variance."""
        table = backbone.words.weight.double()
        centred = table - table.mean(0)
        _, vectors = torch.linalg.eigh(centred.T @ centred)
        found = centred @ vectors.flip(1)[:, : self.words.weight.shape[1]]
        self.words.weight.copy_((found / found.std()).float())
