"""TEMOS and the latent denoiser: what is exported computes what was trained."""

from __future__ import annotations

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import tiny_latent_denoiser, tiny_temos  # noqa: E402

from motionrt_export import specs  # noqa: E402
from motionrt_export.examples import random_examples  # noqa: E402
from motionrt_export.generation_graphs import (  # noqa: E402
    PLACED,
    LatentDenoiserGraph,
    TemosDecoderGraph,
    TemosMotionGraph,
    TemosTextGraph,
    walked,
)
from motionrt_export.layers import Residual  # noqa: E402
from motionrt_export.quantise import product_names  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import open_session, run  # noqa: E402
from motionrt_training.networks.egocentric import from_egocentric  # noqa: E402
from motionrt_training.networks.transformer import key_bias, sinusoidal_positions  # noqa: E402


def masks(batch: int, length: int) -> torch.Tensor:
    mask = torch.ones(batch, length, dtype=torch.bool)
    for row in range(1, batch):
        mask[row, max(1, length // (row + 1)) :] = False
    return mask


@pytest.mark.parametrize("length", [1, 5, 40])
def test_the_text_encoder_gives_the_distribution(length: int) -> None:
    model, mask, features = tiny_temos(), masks(3, length), torch.randn(3, length, 384)
    found = TemosTextGraph(model)(features, mask.long())
    for value, expected in zip(found, model.encode_text(features, mask), strict=True):
        torch.testing.assert_close(value, expected, atol=1e-5, rtol=1e-5)


@pytest.mark.parametrize("patch", [4, 8])
@pytest.mark.parametrize("length", [1, 7, 33, 300])
def test_the_motion_encoder_gives_the_distribution(patch: int, length: int) -> None:
    model, mask = tiny_temos(patch), masks(3, length)
    motion = model.decode(torch.randn(3, 256), torch.ones_like(mask)) + 0.3  # it goes on behind the mask
    found = TemosMotionGraph(model)(motion, mask)
    for value, expected in zip(found, model.encode_motion(motion, mask), strict=True):
        torch.testing.assert_close(value, expected, atol=1e-4, rtol=1e-4)


@pytest.mark.parametrize("patch", [4, 8])
@pytest.mark.parametrize("length", [1, 7, 30, 300])
def test_the_decoder_is_the_one_that_was_trained(patch: int, length: int) -> None:
    model, mask, latent = tiny_temos(patch), masks(3, length), torch.randn(3, 256)
    motion = TemosDecoderGraph(model)(latent, mask)
    torch.testing.assert_close(motion, model.decode(latent, mask), atol=1e-5, rtol=1e-5)
    assert (motion[~mask] == 0).all()


def test_latents_make_different_motions() -> None:
    """Guards the tests above: the projection of a new TEMOS is zero, and every decoder would pass them."""
    motion = tiny_temos().decode(torch.randn(2, 256), masks(1, 20).expand(2, -1))
    assert float((motion[0] - motion[1]).abs().max()) > 0.01


def test_frames_in_another_order_walk_the_same_way() -> None:
    frames = torch.randn(2, 15, 136)
    torch.testing.assert_close(walked(frames[:, :, list(PLACED)]), from_egocentric(frames), atol=1e-5, rtol=1e-5)


@pytest.mark.parametrize("layers", [1, 3, 5])
def test_the_step_is_the_guided_estimate(layers: int) -> None:
    model, text = tiny_latent_denoiser(layers), torch.randn(4, 256)
    guidance, times, latent = torch.tensor([0.0, 1.0, 2.5, 7.0]), torch.tensor([0, 17, 500, 999]), torch.randn(4, 256)
    found = LatentDenoiserGraph(model)(latent, times, text, guidance)
    wanted = model.guided(latent, times, text[:, None], torch.ones(4, 1), guidance)
    for value, expected in zip(found, wanted, strict=True):
        torch.testing.assert_close(value, expected, atol=2e-5, rtol=1e-5)


def test_guidance_and_text_count_in_the_step() -> None:
    step, text, one = LatentDenoiserGraph(tiny_latent_denoiser()), torch.randn(1, 256), torch.ones(1)
    given = torch.randn(1, 256), torch.tensor([700]), text
    latent, times, _ = given
    assert not torch.allclose(step(*given, one)[0], step(*given, 2 * one)[0], atol=1e-3)
    other = latent, times, text + 1.0
    torch.testing.assert_close(step(*given, 0 * one)[0], step(*other, 0 * one)[0])
    assert not torch.allclose(step(*given, one)[0], step(*other, one)[0], atol=1e-3)


GRAPHS = [
    (specs.TEMOS_TEXT, lambda: TemosTextGraph(tiny_temos())),
    (specs.TEMOS_MOTION, lambda: TemosMotionGraph(tiny_temos())),
    (specs.TEMOS_DECODER, lambda: TemosDecoderGraph(tiny_temos())),
    (specs.LATENT_DENOISER, lambda: LatentDenoiserGraph(tiny_latent_denoiser())),
]


@pytest.mark.parametrize(("spec", "module"), GRAPHS)
def test_the_file_takes_other_sizes_than_the_traced_one(spec, module) -> None:
    module = module()
    session = open_session(trace(module, spec).SerializeToString())
    for batch, length in ((1, 1), (3, 30)):
        feeds = random_examples(spec)(batch, length, seed=batch)
        expected = module(*(torch.from_numpy(feeds[tensor.name]) for tensor in spec.inputs))
        found = run(session, feeds)
        for tensor, value in zip(spec.outputs, (expected,) if len(spec.outputs) == 1 else expected, strict=True):
            np.testing.assert_allclose(found[tensor.name], value.detach().numpy(), atol=1e-4)


def test_the_statistics_of_the_network_stay_as_they_were() -> None:
    model, denoiser = tiny_temos(), tiny_latent_denoiser()
    before = {name: value.clone() for net in (model, denoiser) for name, value in net.state_dict().items()}
    for graph, net in ((TemosMotionGraph, model), (TemosDecoderGraph, model), (LatentDenoiserGraph, denoiser)):
        graph(net)
    after = {name: value for net in (model, denoiser) for name, value in net.state_dict().items()}
    assert all(torch.equal(after[name], value) for name, value in before.items())


@pytest.mark.parametrize(("index", "name"), [(0, "/project/"), (1, "/gather/"), (2, "/hear/"), (3, "/skips.0/")])
def test_the_widest_products_are_there_to_be_quantised(index: int, name: str) -> None:
    spec, module = GRAPHS[index]
    assert len(product_names(trace(module(), spec), name)) == 1


def test_one_linear_map_gives_the_queries_and_what_every_layer_hears() -> None:
    model, latent = tiny_temos(), torch.randn(2, 256)
    decoder = model.motion_decoder
    heard = TemosDecoderGraph(model).hear(latent).view(2, -1, 256)
    for index, layer in enumerate(decoder.layers):
        torch.testing.assert_close(heard[:, index : index + 1], layer.cross(latent), atol=1e-5, rtol=1e-5)
    places = sinusoidal_positions(decoder.most, 256, latent)
    wanted = decoder.spread(latent).view(2, -1, 256) + places
    torch.testing.assert_close(heard[:, len(decoder.layers) :], wanted, atol=1e-5, rtol=1e-5)


def test_the_last_layer_answers_for_two_tokens() -> None:
    source = tiny_temos().motion_encoder.layers[0]
    x, bias = torch.randn(2, 9, 256), key_bias(masks(2, 9))
    torch.testing.assert_close(Residual(source, first=2)(x, bias), source(x, bias)[:, :2], atol=1e-5, rtol=1e-5)
