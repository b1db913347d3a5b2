"""The torch modules as `motionrt bench --against torch` runs them: what somebody with torch would otherwise
use.

Inference mode, float32, batch 1, torch's own fused attention, the same tokenizer, and exact search by matmul
and topk.
"""

from __future__ import annotations

import sys
from itertools import cycle
from pathlib import Path

import torch
import torch.nn.functional as F
from tokenizers import Tokenizer
from torch import Tensor

from motionrt.bench.rivals import Rival
from motionrt.bench.timing import Call
from motionrt.bench.workload import ANSWER, MOTION, SEARCH_SIZES, TEXT, TEXTS, TOP, Workload, search_case
from motionrt.models import find_manifest
from motionrt_export.torch_makes import make_cases
from motionrt_export.torch_moves import move_cases, released
from motionrt_training.networks.minilm import MAX_TOKENS, MiniLM, package_folder
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transformer import set_fused_attention

RELEASED = "models"  # folder of the released networks, beneath that of the manifest


class TorchModel:
    """Text and motion encoders in torch."""

    def __init__(self, models: str | None = None) -> None:
        self.tokenizer = Tokenizer.from_file(str(package_folder() / "tokenizer.json"))
        self.tokenizer.no_padding()
        self.tokenizer.enable_truncation(MAX_TOKENS)
        self.sentences = MiniLM.from_package()
        self.tmr = released(TMR, _folder(models))
        set_fused_attention(self.sentences.eval(), fused=True)

    @torch.inference_mode()
    def embed_text(self, text: str) -> Tensor:
        """Unit embedding (256,)."""
        return F.normalize(self.tmr.encode_text(*self.encode(text)).mu[0], dim=0)

    @torch.inference_mode()
    def encode(self, text: str) -> tuple[Tensor, Tensor]:
        """Features of the tokens (1, T, 384) and their mask (1, T)."""
        ids = torch.tensor([self.tokenizer.encode(text).ids])
        mask = torch.ones_like(ids)
        return self.sentences(ids, mask), mask

    @torch.inference_mode()
    def embed_motion(self, features: Tensor) -> Tensor:
        """Raw guo263 features (F, 263) -> unit embedding (256,)."""
        mask = torch.ones(1, len(features), dtype=torch.bool)
        return F.normalize(self.tmr.encode_motion(features[None], mask).mu[0], dim=0)


def open_torch(work: Workload, threads: int, models: str | None = None) -> Rival:
    """The rival called `torch`."""
    torch.set_num_threads(threads)
    model, texts = TorchModel(models), cycle(work.texts)
    features, vectors = torch.from_numpy(work.features), torch.from_numpy(work.vectors)
    cases: dict[str, Call] = {
        TEXT: lambda: model.embed_text(next(texts)),
        MOTION: lambda: model.embed_motion(features),
        ANSWER: lambda: _nearest(vectors[:10_000], model.embed_text(next(texts))),
    }
    for size in SEARCH_SIZES:
        cases[search_case(size)] = _search(vectors[:size], vectors[-1])
    cases |= move_cases(work.moves, _folder(models)) | make_cases(model.encode, _folder(models))
    return Rival(cases, [sys.executable, "-m", "motionrt_export.torch_rival", *([models] if models else [])])


def _folder(models: str | None) -> Path:
    """Where the released networks lie."""
    return Path(find_manifest(models)).parent / RELEASED


def _search(vectors: Tensor, query: Tensor) -> Call:
    return lambda: _nearest(vectors, query)


def _nearest(vectors: Tensor, query: Tensor) -> Tensor:
    return (vectors @ query).topk(TOP).indices


if __name__ == "__main__":
    TorchModel(sys.argv[1] if len(sys.argv) > 1 else None).embed_text(TEXTS[0])
    print("embedded", flush=True)
