"""What is exported computes what was trained, with attention folded and one token in the last layer."""

from __future__ import annotations

import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")

from tiny_nets import tiny_minilm, tiny_student, tiny_tmr  # noqa: E402

from motionrt_export.graphs import (  # noqa: E402
    DecoderGraph,
    MotionEncoderGraph,
    SentenceEncoderGraph,
    StudentGraph,
    TextGraph,
)
from motionrt_export.layers import Attention, folded  # noqa: E402
from motionrt_training.networks.minilm import mean_pooled  # noqa: E402
from motionrt_training.networks.transformer import (  # noqa: E402
    DecoderLayer,
    MultiHeadSelfAttention,
    key_bias,
)


def masks(batch: int, length: int) -> torch.Tensor:
    mask = torch.ones(batch, length, dtype=torch.bool)
    for row in range(1, batch):
        mask[row, max(1, length // (row + 1)) :] = False
    return mask


@pytest.mark.parametrize("patch", [1, 4])
@pytest.mark.parametrize("length", [1, 3, 8, 33])
def test_the_motion_encoder_is_the_one_that_was_trained(patch: int, length: int) -> None:
    model, mask = tiny_tmr(patch), masks(3, length)
    motion = torch.randn(3, length, 263) * model.motion_std + model.motion_mean
    embedding, latent = MotionEncoderGraph(model)(motion, mask)
    expected = model.encode_motion(motion, mask).mu
    torch.testing.assert_close(latent, expected, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(embedding, torch.nn.functional.normalize(expected, dim=-1), atol=1e-6, rtol=0)


@pytest.mark.parametrize("length", [1, 5, 40])
def test_the_text_encoder_is_the_one_that_was_trained(length: int) -> None:
    backbone, model, mask = tiny_minilm(), tiny_tmr(), masks(3, length)
    ids = torch.randint(0, 2000, (3, length))
    embedding, latent, features, sentence = TextGraph(backbone, model)(ids, mask.long())
    expected = model.encode_text(backbone(ids, mask), mask).mu
    torch.testing.assert_close(sentence, mean_pooled(features, mask), atol=1e-6, rtol=0)
    torch.testing.assert_close(latent, expected, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(embedding.norm(dim=-1), torch.ones(3), atol=1e-6, rtol=0)


@pytest.mark.parametrize("words", [32, 64, 96])  # fewer, as many and more directions than the layers are wide
@pytest.mark.parametrize("length", [1, 5, 40])
def test_the_small_text_tower_is_the_one_that_was_trained(words: int, length: int) -> None:
    model, mask = tiny_student(words), masks(3, length)
    ids = torch.randint(0, 2000, (3, length))
    graph = StudentGraph(model)
    embedding, latent = graph(ids, mask.long())
    expected = model(ids, mask)
    torch.testing.assert_close(latent, expected, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(embedding, torch.nn.functional.normalize(expected, dim=-1), atol=1e-6, rtol=0)
    assert graph.words.weight.shape == (2000, min(words, 64))


@pytest.mark.parametrize("patch", [1, 4])
@pytest.mark.parametrize("length", [1, 7, 30])
def test_the_decoder_is_the_one_that_was_trained(patch: int, length: int) -> None:
    model, mask = tiny_tmr(patch), masks(3, length)
    latent = torch.randn(3, 256)
    motion = DecoderGraph(model)(latent, mask)
    torch.testing.assert_close(motion, model.decode(latent, mask), atol=1e-5, rtol=1e-5)
    assert (motion[~mask] == 0).all()


def test_the_sentence_encoder_is_the_backbone_with_its_pooling() -> None:
    backbone, mask = tiny_minilm(), masks(3, 12)
    ids = torch.randint(0, 2000, (3, 12))
    features, sentence = SentenceEncoderGraph(backbone)(ids, mask.long())
    expected = backbone(ids, mask)
    torch.testing.assert_close(features[mask], expected[mask], atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(sentence, mean_pooled(expected, mask), atol=1e-6, rtol=0)


@pytest.mark.parametrize("heads", [4, 12])  # d/heads is 96 and 32: the factor is no power of two
def test_attention_of_the_first_token_is_the_first_row_of_the_full_one(heads: int) -> None:
    source = MultiHeadSelfAttention(384, heads)
    x, bias = torch.randn(2, 9, 384), key_bias(masks(2, 9))
    full = source(x, bias)
    torch.testing.assert_close(Attention(source)(x, bias), full, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(Attention(source, first=1)(x, bias), full[:, :1], atol=1e-5, rtol=1e-5)


def test_one_linear_map_holds_the_cross_attention_of_all_layers() -> None:
    layers = [DecoderLayer(16, 2, 8) for _ in range(3)]
    latent = torch.randn(4, 16)
    expected = torch.cat([layer.cross(latent)[:, 0] for layer in layers], dim=-1)
    torch.testing.assert_close(folded([layer.cross for layer in layers])(latent), expected, atol=1e-6, rtol=1e-5)
