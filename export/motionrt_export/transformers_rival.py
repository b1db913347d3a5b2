"""Text queries with torch and transformers, for `motionrt bench --against transformers`.

The sentence encoder is transformers' `BertModel`, as somebody without motionrt would run it; TMR's text encoder behind
it is the torch module, and so is the search.
"""

from __future__ import annotations

import sys
from pathlib import Path

import torch
import torch.nn.functional as F
from torch import Tensor

from motionrt.bench.rivals import Rival
from motionrt.bench.workload import Workload
from motionrt_export import transformers_text
from motionrt_export.torch_locomotion import released
from motionrt_export.torch_rival import released_folder, text_cases
from motionrt_export.transformers_text import TransformersSentences
from motionrt_training.networks.minilm import package_folder
from motionrt_training.networks.tmr import TMR


def open_transformers(work: Workload, threads: int, models: str | None = None) -> Rival:
    """The rival called `transformers`."""
    torch.set_num_threads(threads)
    folder = package_folder()
    sentences, tmr = TransformersSentences(folder), released(TMR, released_folder(models))

    @torch.inference_mode()
    def embed(text: str) -> Tensor:
        return F.normalize(tmr.encode_text(*sentences.encode(text)).mu[0], dim=0)

    return Rival(text_cases(work, embed), [sys.executable, str(Path(transformers_text.__file__)), str(folder)])
