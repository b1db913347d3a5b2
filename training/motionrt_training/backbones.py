"""Frozen text backbones: the shipped ONNX sentence encoder, MiniLM in torch, a Hugging Face folder."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from motionrt_training.networks.minilm import MAX_TOKENS, SHA256, MiniLM, mean_pooled, package_folder

Encoded = tuple[NDArray[np.float32], NDArray[np.float32]]  # token features (T, width), sentence (width,)


class Backbone(Protocol):
    """A frozen encoder of one text."""

    fingerprint: str

    def encode(self, text: str) -> Encoded:
        """Token features (T, width) and the unit-norm sentence embedding (width,)."""


def open_backbone(kind: str, path: str | Path | None = None) -> Backbone:
    """`onnx` (path of the text model), `minilm` (the installed package) or `hf` (path of a model folder)."""
    if kind == "minilm":
        return MiniLMBackbone()
    if kind not in ("onnx", "hf"):
        raise ValueError(f"unknown backbone {kind!r}; choose onnx, minilm or hf")
    if path is None:
        raise ValueError(f"backbone {kind!r} needs a path: give --backbone-path")
    return OnnxBackbone(path) if kind == "onnx" else HuggingFaceBackbone(path)


class MiniLMBackbone:
    """The fp32 weights of the installed package, run by `MiniLM`."""

    def __init__(self) -> None:
        self.model = MiniLM.from_package()
        self.tokenizer = _tokenizer(package_folder() / "tokenizer.json")
        self.fingerprint = f"minilm-{SHA256}"

    @torch.no_grad()
    def encode(self, text: str) -> Encoded:
        """Token features, mask and sentence embedding of one text."""
        ids = torch.tensor([self.tokenizer.encode(text).ids])
        mask = torch.ones_like(ids)
        tokens = self.model(ids, mask)
        return tokens[0].numpy(), mean_pooled(tokens, mask)[0].numpy()

    @torch.no_grad()
    def encode_together(self, texts: Sequence[str]) -> list[Encoded]:
        """The same for several texts in one pass."""
        ids = [torch.tensor(one.ids) for one in self.tokenizer.encode_batch(list(texts))]
        mask = nn.utils.rnn.pad_sequence([torch.ones_like(one) for one in ids], batch_first=True)
        tokens = self.model(nn.utils.rnn.pad_sequence(ids, batch_first=True), mask)
        sentences = mean_pooled(tokens, mask).numpy()
        return [(row[: len(one)].numpy(), sentence) for row, one, sentence in zip(tokens, ids, sentences, strict=True)]


class OnnxBackbone:
    """The exported text model, of which the sentence encoder is the first part: what is trained on is what is run."""

    def __init__(self, path: str | Path) -> None:
        import onnxruntime

        path = Path(path)
        if not path.is_file():
            raise FileNotFoundError(f"no text model at {path}; export it first")
        beside = path.parent / "tokenizer.json"
        self.tokenizer = _tokenizer(beside if beside.is_file() else package_folder() / "tokenizer.json")
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1  # texts are short, and training wants the cores
        self.session = onnxruntime.InferenceSession(path, options, providers=["CPUExecutionProvider"])
        switches = [*self.session.get_inputs(), *self.session.get_overridable_initializers()]
        named = "embed" in [value.name for value in switches]
        self._only = {"embed": np.array(False)} if named else {}  # nothing behind the sentence encoder
        self.fingerprint = f"onnx-{hashlib.sha256(path.read_bytes()).hexdigest()}"

    def encode(self, text: str) -> Encoded:
        """Token features, mask and sentence embedding of one text."""
        ids = np.array([self.tokenizer.encode(text).ids], dtype=np.int64)
        feed = {"input_ids": ids, "attention_mask": np.ones_like(ids), **self._only}
        tokens, sentence = self.session.run(["token_features", "sentence_embedding"], feed)
        return tokens[0], sentence[0]


class HuggingFaceBackbone:
    """Any encoder that `transformers` opens from a local folder, such as DistilBERT."""

    def __init__(self, path: str | Path) -> None:
        try:
            from transformers import AutoModel, AutoTokenizer
        except ImportError as error:
            raise ImportError("backbone 'hf' needs transformers; run: pip install transformers") from error
        self.tokenizer: Any = AutoTokenizer.from_pretrained(path, local_files_only=True)
        self.model: Any = AutoModel.from_pretrained(path, local_files_only=True).eval()
        self.fingerprint = f"hf-{_weights_digest(self.model)}"

    @torch.no_grad()
    def encode(self, text: str) -> Encoded:
        """Token features, mask and sentence embedding of one text."""
        inputs = self.tokenizer(text, return_tensors="pt", truncation=True, max_length=MAX_TOKENS)
        tokens = self.model(**inputs).last_hidden_state
        return tokens[0].numpy(), mean_pooled(tokens, inputs["attention_mask"])[0].numpy()


def _tokenizer(path: Path) -> Any:
    from tokenizers import Tokenizer

    tokenizer = Tokenizer.from_file(str(path))
    tokenizer.no_padding()
    tokenizer.enable_truncation(MAX_TOKENS)
    return tokenizer


def _weights_digest(model: torch.nn.Module) -> str:
    digest = hashlib.sha256()
    for name, value in model.state_dict().items():
        digest.update(name.encode("utf-8"))
        digest.update(value.contiguous().view(-1).view(torch.uint8).numpy().tobytes())
    return digest.hexdigest()
