"""The torch modules as `motionrt bench --against torch` runs them: what somebody with torch would otherwise
use.

Inference mode, float32, texts one by one, clips in one batch, torch's own fused attention, the same tokenizer, and
exact search by matmul and topk.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from itertools import cycle
from pathlib import Path

import torch
import torch.nn.functional as F
from tokenizers import Tokenizer
from torch import Tensor

from motionrt.bench.first_answer import peak_mb
from motionrt.bench.rivals import Rival
from motionrt.bench.search import CLIPS, FULL_TEXT, TEXT, answer_case, motion_case, search_case
from motionrt.bench.timing import Call
from motionrt.bench.workload import TEXTS, TOP, Workload
from motionrt.models import find_manifest
from motionrt_export.torch_generation import make_cases
from motionrt_export.torch_graphs import graph_cases
from motionrt_export.torch_locomotion import move_cases, released
from motionrt_training.networks.minilm import MAX_TOKENS, MiniLM, package_folder
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transformer import set_fused_attention

RELEASED = "models"  # folder of the released networks, beneath that of the manifest
Embed = Callable[[str], Tensor]


class TorchModel:
    """Text and motion encoders in torch."""

    def __init__(self, models: str | None = None) -> None:
        self.tokenizer = Tokenizer.from_file(str(package_folder() / "tokenizer.json"))
        self.tokenizer.no_padding()
        self.tokenizer.enable_truncation(MAX_TOKENS)
        self.sentences = MiniLM.from_package()
        self.tmr = released(TMR, released_folder(models))
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
        """Raw guo263 features (B, F, 263) -> unit embeddings (B, 256), all in one batch."""
        mask = torch.ones(features.shape[:2], dtype=torch.bool)
        return F.normalize(self.tmr.encode_motion(features, mask).mu, dim=1)


def open_torch(work: Workload, threads: int, models: str | None = None) -> Rival:
    """The rival called `torch`."""
    torch.set_num_threads(threads)
    model, folder = TorchModel(models), released_folder(models)
    cases = text_cases(work, model.embed_text) | search_cases(work)
    features = torch.from_numpy(work.features)
    cases |= {motion_case(count): motion_call(model, features, count) for count in CLIPS}
    cases |= move_cases(work.moves, folder) | make_cases(model.encode, folder)
    cases |= graph_cases(models, model.sentences, folder)
    return Rival(cases, [sys.executable, "-m", "motionrt_export.torch_rival", *([models] if models else [])])


def text_cases(work: Workload, embed: Embed) -> dict[str, Call]:
    """A text embedded, and looked for among galleries of every size; by the full text tower, which needs no other."""
    texts, vectors = cycle(work.texts), torch.from_numpy(work.vectors)
    alone = dict.fromkeys((TEXT, FULL_TEXT), lambda: embed(next(texts)))
    answers = {answer_case(n): _answer(vectors[:n], embed, work.texts) for n in work.sizes}
    return alone | answers


def search_cases(work: Workload) -> dict[str, Call]:
    """Exact search."""
    vectors = torch.from_numpy(work.vectors)
    return {search_case(n): _search(vectors[:n], vectors[-1]) for n in work.sizes}


def motion_call(model: TorchModel, features: Tensor, count: int) -> Call:
    """So many clips in one batch."""
    batch = features.expand(count, -1, -1).contiguous()
    return lambda: model.embed_motion(batch)


def released_folder(models: str | None) -> Path:
    """Where the released networks lie."""
    return Path(find_manifest(models)).parent / RELEASED


def _answer(vectors: Tensor, embed: Embed, given: tuple[str, ...]) -> Call:
    texts = cycle(given)
    return lambda: _nearest(vectors, embed(next(texts)))


def _search(vectors: Tensor, query: Tensor) -> Call:
    return lambda: _nearest(vectors, query)


def _nearest(vectors: Tensor, query: Tensor) -> Tensor:
    return (vectors @ query).topk(TOP).indices


if __name__ == "__main__":
    TorchModel(sys.argv[1] if len(sys.argv) > 1 else None).embed_text(TEXTS[0])
    print(json.dumps({"peak_mb": peak_mb()}), flush=True)
