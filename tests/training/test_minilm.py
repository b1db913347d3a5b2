"""MiniLM in plain torch against the figures that its authors publish."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")
pytest.importorskip("safetensors", reason="training tests need safetensors (extra 'train')")

from motionrt_training.backbones import MiniLMBackbone, open_backbone  # noqa: E402
from motionrt_training.networks.minilm import PACKAGE, MiniLM, mean_pooled  # noqa: E402

needs_package = pytest.mark.skipif(
    importlib.util.find_spec(PACKAGE) is None,
    reason=f"package {PACKAGE} with the MiniLM weights is not installed",
)


@needs_package
def test_similarities_are_those_of_the_sentence_transformers_manual() -> None:
    backbone = MiniLMBackbone()
    sentences = ["The weather is lovely today.", "It's so sunny outside!", "He drove to the stadium."]
    first, second, third = (torch.from_numpy(backbone.encode(text)[1]) for text in sentences)
    assert float(first @ second) == pytest.approx(0.6660, abs=1e-4)
    assert float(first @ third) == pytest.approx(0.1046, abs=1e-4)
    assert float(second @ third) == pytest.approx(0.1411, abs=1e-4)


@needs_package
def test_padding_does_not_change_the_features_of_a_text() -> None:
    model, ids = MiniLM.from_package(), torch.tensor([[101, 2158, 7365, 102]])
    padded = torch.cat((ids, torch.zeros(1, 3, dtype=torch.int64)), dim=1)
    mask = (torch.arange(7) < 4).long()[None]
    torch.testing.assert_close(model(padded, mask)[:, :4], model(ids, mask[:, :4]), atol=1e-5, rtol=1e-5)


def test_mean_pooling_leaves_padding_out() -> None:
    tokens = torch.tensor([[[3.0, 0.0], [0.0, 4.0], [99.0, 99.0]]])
    pooled = mean_pooled(tokens, torch.tensor([[1, 1, 0]]))
    torch.testing.assert_close(pooled, torch.tensor([[0.6, 0.8]]))


def test_an_unknown_backbone_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown backbone"):
        open_backbone("bert")
    with pytest.raises(ValueError, match="needs a path"):
        open_backbone("onnx")


def test_other_weights_than_the_published_ones_are_refused(tmp_path: object) -> None:
    from pathlib import Path

    folder = Path(str(tmp_path))
    (folder / "model.safetensors").write_bytes(b"not the weights")
    with pytest.raises(ValueError, match="sha256"):
        MiniLM.from_folder(folder, sha256="0" * 64)


@needs_package
def test_texts_read_together_have_the_features_of_texts_read_alone() -> None:
    backbone = MiniLMBackbone()
    texts = ["jump", "a person walks forward and turns to the left, then waves", "kick with the right leg"]
    for text, (tokens, sentence) in zip(texts, backbone.encode_together(texts), strict=True):
        alone, whole = backbone.encode(text)
        np.testing.assert_allclose(tokens, alone, atol=2e-5)
        np.testing.assert_allclose(sentence, whole, atol=2e-6)
