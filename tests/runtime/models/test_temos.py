"""TEMOS and the denoiser as typed functions: shapes, what the tiny graphs say, refusals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tiny_models import TINY, TINY_GENERATORS

from motionrt.errors import InvalidInputError, ModelNotFoundError
from motionrt.models import LatentDenoiser, LatentDistribution, SentenceEncoder, SentenceFeatures, Sessions, TemosModel


@pytest.fixture(scope="module")
def sessions() -> Sessions:
    return Sessions(TINY_GENERATORS, threads=1)


@pytest.fixture(scope="module")
def model(sessions: Sessions) -> TemosModel:
    return TemosModel(sessions)


@pytest.fixture(scope="module")
def text(sessions: Sessions) -> SentenceFeatures:
    return SentenceEncoder(sessions).encode("wave the right hand")


def frames(batch: int, valid: int, length: int) -> np.ndarray:
    return np.tile(np.arange(length) < valid, (batch, 1))


def test_a_text_is_a_distribution_of_latents(model: TemosModel, text: SentenceFeatures) -> None:
    found = model.encode_text(text)
    np.testing.assert_allclose(found.mu[0], text.token_features[0].mean(axis=0)[:256], atol=1e-6)
    np.testing.assert_allclose(found.logvar, np.full((1, 256), np.log(0.25)), atol=1e-6)


def test_padded_tokens_do_not_count(model: TemosModel, text: SentenceFeatures) -> None:
    padded = np.concatenate([text.token_features, np.full((1, 3, 384), 9, np.float32)], axis=1)
    mask = np.concatenate([text.attention_mask, np.zeros((1, 3), np.int64)], axis=1)
    found = model.encode_text(replace(text, token_features=padded, attention_mask=mask))
    np.testing.assert_allclose(found.mu, model.encode_text(text).mu, atol=1e-6)


def test_a_latent_is_the_mean_plus_noise_times_the_deviation() -> None:
    given = LatentDistribution(np.full((2, 3), 5, np.float32), np.log(np.array([[4, 1, 0.25]] * 2, np.float32)))
    np.testing.assert_allclose(given.at(np.ones((2, 3), np.float32)), [[7, 6, 5.5]] * 2, rtol=1e-6)
    assert given.at(np.ones((2, 3), np.float64)).dtype == np.float32


def test_a_motion_is_a_distribution_of_its_valid_frames(model: TemosModel) -> None:
    motion = np.random.default_rng(3).normal(size=(2, 30, 135)).astype(np.float32)
    expected = np.sin(motion[:, :20].mean(axis=1))
    found = model.encode_motion(motion, frames(2, 20, 30))
    np.testing.assert_allclose(found.mu[:, :135], expected, atol=1e-5)
    np.testing.assert_allclose(model.encode_motion(motion[:, :20]).mu, found.mu, atol=1e-5)


def test_a_padding_of_nan_is_no_reason_to_refuse_a_motion(model: TemosModel) -> None:
    motion = np.zeros((1, 5, 135), np.float32)
    motion[0, 4] = np.nan
    with pytest.raises(InvalidInputError, match="not finite"):
        model.encode_motion(motion)
    model.encode_motion(motion, frames(1, 4, 5))


def test_decoding_gives_zeros_where_no_frame_is_wanted(model: TemosModel) -> None:
    latents = np.random.default_rng(4).normal(size=(2, 256)).astype(np.float32)
    found = model.decode(latents, frames(2, 12, 20))
    assert found.shape == (2, 20, 135)
    assert found.dtype == np.float32
    assert not found[:, 12:].any()
    np.testing.assert_allclose(found[:, :12], model.decode(latents, frames(2, 12, 12)), atol=1e-6)


@pytest.mark.parametrize("shape", [(1, 255), (256,), (1, 1, 256)])
def test_latents_of_another_shape_are_refused(model: TemosModel, shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match=r"expected latents \(B, 256\), found shape"):
        model.decode(np.zeros(shape, np.float32), frames(1, 5, 5))


def test_latents_that_are_not_finite_are_refused(model: TemosModel) -> None:
    with pytest.raises(InvalidInputError, match="not finite"):
        model.decode(np.full((1, 256), np.inf, np.float32), frames(1, 5, 5))


@pytest.mark.parametrize("mask", [np.ones((2, 5)), np.ones(5), np.zeros((1, 5)), np.ones((1, 0))])
def test_masks_of_another_shape_or_without_a_frame_are_refused(model: TemosModel, mask: np.ndarray) -> None:
    with pytest.raises(InvalidInputError, match="mask"):
        model.decode(np.zeros((1, 256), np.float32), mask.astype(bool))


@pytest.mark.parametrize("shape", [(5, 135), (1, 5, 134), (1, 0, 135)])
def test_motions_of_another_shape_are_refused(model: TemosModel, shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match=r"sinc135|frame"):
        model.encode_motion(np.zeros(shape, np.float32))


def test_token_features_of_another_width_are_refused(model: TemosModel, text: SentenceFeatures) -> None:
    with pytest.raises(InvalidInputError, match=r"\(B, T, 384\)"):
        model.encode_text(replace(text, token_features=text.token_features[..., :383]))
    with pytest.raises(InvalidInputError, match=r"\(B, T, 384\)"):
        model.encode_text(replace(text, attention_mask=text.attention_mask[:, 1:]))


def test_models_without_temos_say_what_they_have(text: SentenceFeatures) -> None:
    with pytest.raises(ModelNotFoundError, match="no model 'temos_text'"):
        TemosModel(Sessions(TINY)).encode_text(text)


def denoise(sessions: Sessions, text: SentenceFeatures, **changes: Any) -> tuple[np.ndarray, np.ndarray]:
    given = {
        "latent": np.ones((1, 256), np.float32),
        "timestep": np.array([500]),
        "text_latent": text.token_features.mean(axis=1)[:, :256],
        "guidance": np.array([3.0]),
    }
    return LatentDenoiser(sessions)(**{**given, **changes})


def test_the_denoiser_answers_in_both_units(sessions: Sessions, text: SentenceFeatures) -> None:
    normalised, clean = denoise(sessions, text)
    told = text.token_features[0].mean(axis=0)[:256]
    np.testing.assert_allclose(normalised[0], 0.5 + 3 * told, atol=1e-5)
    np.testing.assert_allclose(clean, 2 * normalised + 0.1, atol=1e-5)


@pytest.mark.parametrize(
    "changes",
    [
        {"latent": np.zeros((1, 255))},
        {"latent": np.zeros((2, 256))},
        {"latent": np.full((1, 256), np.nan)},
        {"timestep": np.array([1000])},
        {"timestep": np.array([-1])},
        {"timestep": np.array([1, 2])},
        {"guidance": np.array(2.0)},
        {"text_latent": np.zeros((1, 384))},
    ],
)
def test_the_denoiser_refuses_what_does_not_fit(
    sessions: Sessions, text: SentenceFeatures, changes: dict[str, np.ndarray]
) -> None:
    with pytest.raises(InvalidInputError):
        denoise(sessions, text, **changes)
