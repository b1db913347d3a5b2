"""A text's embedding by torch and transformers, from the files of all-MiniLM-L6-v2 alone: no hub, nothing of motionrt.

    python transformers_text.py FOLDER [TEXT]

FOLDER holds config.json, model.safetensors and the tokenizer. Prints JSON as soon as the text is embedded: the norm of
its embedding, and the most memory that the process has held.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import torch
from torch import Tensor
from transformers import AutoTokenizer, BertModel


class TransformersSentences:
    """What somebody with torch and transformers would write: `BertModel`, its tokenizer, and the mean of the tokens."""

    def __init__(self, folder: str | Path) -> None:
        self.tokenizer: Any = AutoTokenizer.from_pretrained(str(folder), local_files_only=True)
        self.model: Any = BertModel.from_pretrained(str(folder), local_files_only=True, add_pooling_layer=False).eval()

    @torch.inference_mode()
    def encode(self, text: str) -> tuple[Tensor, Tensor]:
        """Features of the tokens (1, T, 384) and their mask (1, T)."""
        given = self.tokenizer(text, truncation=True, max_length=128, return_tensors="pt")
        return self.model(**given).last_hidden_state, given["attention_mask"]

    @torch.inference_mode()
    def embed(self, text: str) -> Tensor:
        """Unit embedding (384,)."""
        features, mask = self.encode(text)
        return torch.nn.functional.normalize((features * mask[..., None]).sum(1) / mask.sum(), dim=-1)[0]


def peak_mb() -> float | None:
    """The most memory this process has held, in MB; None where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


if __name__ == "__main__":
    embedding = TransformersSentences(sys.argv[1]).embed(" ".join(sys.argv[2:]) or "a person walks in a circle")
    print(json.dumps({"norm": float(embedding.norm()), "peak_mb": peak_mb()}), flush=True)
