"""Texts: what is refused, what is cut, and that neighbours and padding never matter."""

from __future__ import annotations

import numpy as np
import pytest
from tiny_models import TINY

from motionrt.errors import InvalidInputError, ManifestError
from motionrt.models import SentenceEncoder, Sessions
from motionrt.models.text import load_tokenizer

CLS, SEP, UNK = 2, 3, 1


@pytest.fixture(scope="module")
def encoder() -> SentenceEncoder:
    return SentenceEncoder(Sessions(TINY, threads=1))


def test_tokens_have_the_markers_around_them(encoder: SentenceEncoder) -> None:
    ids = encoder.tokens("A person walks")
    assert ids.dtype == np.int64
    assert ids[0] == CLS
    assert ids[-1] == SEP
    assert len(ids) == 5
    np.testing.assert_array_equal(ids, encoder.tokens("a PERSON walks"))


def test_features_are_those_of_the_formula(encoder: SentenceEncoder) -> None:
    """The tiny encoder is a sine of the id, so NumPy can do it, too."""
    ids = encoder.tokens("walks forward")
    rate, phase = np.linspace(0.2, 2.9, 384), np.linspace(0, 40, 384)
    expected = np.sin(ids[:, None] * rate + phase)
    found = encoder.encode("walks forward")
    np.testing.assert_allclose(found.token_features[0], expected, atol=1e-4)
    mean = expected.mean(axis=0)
    np.testing.assert_allclose(found.sentence_embedding, mean / np.linalg.norm(mean), atol=2e-5)
    assert found.attention_mask.tolist() == [[1] * len(ids)]


def test_features_are_had_without_what_a_search_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    sessions = Sessions(TINY, threads=1)
    asked: list[dict[str, np.ndarray]] = []
    run = sessions.run
    monkeypatch.setattr(sessions, "run", lambda *given: (asked.append(given[2]), run(*given))[1])
    SentenceEncoder(sessions).encode("walk")
    assert not asked[0]["embed"]
    ids = {name: asked[0][name] for name in ("input_ids", "attention_mask")}
    whole, none = run("tmr_text", ["latent"], ids)[0], run("tmr_text", ["latent"], asked[0])[0]
    assert (whole.shape, none.shape) == ((1, 256), (0, 256))


def test_a_long_text_is_cut_at_128_tokens(encoder: SentenceEncoder) -> None:
    ids = encoder.tokens("walk " * 500)
    assert len(ids) == 128
    assert ids[-1] == SEP
    assert encoder.encode("walk " * 500).token_features.shape == (1, 128, 384)


def test_an_embedding_does_not_depend_on_its_neighbours(encoder: SentenceEncoder) -> None:
    texts = ["walk", "a man jumps up and down on both feet", "run " * 90]
    together = encoder.embed(texts)
    for text, row in zip(texts, together, strict=True):
        np.testing.assert_array_equal(encoder.embed([text])[0], row)
    np.testing.assert_allclose(np.linalg.norm(together, axis=1), 1, atol=1e-6)


@pytest.mark.parametrize("text", ["Ünïcödé", "歩く", "🕺 dances", "naïve\u200bwalk", "walk\x00", "\ud800"[:0] + "é"])
def test_text_beyond_ascii_is_fine(encoder: SentenceEncoder, text: str) -> None:
    assert np.isfinite(encoder.embed([text])).all()


def test_no_texts_give_no_rows(encoder: SentenceEncoder) -> None:
    assert encoder.embed([]).shape == (0, 384)


@pytest.mark.parametrize("text", ["", "   ", "\t\n", "\u3000"])
def test_an_empty_text_is_refused(encoder: SentenceEncoder, text: str) -> None:
    with pytest.raises(InvalidInputError, match="the text is empty; describe a motion"):
        encoder.encode(text)


@pytest.mark.parametrize("text", [None, 3, b"walk", ["walk"], float("nan")])
def test_anything_but_a_string_is_refused(encoder: SentenceEncoder, text: object) -> None:
    with pytest.raises(InvalidInputError, match="a text must be a str, not"):
        encoder.embed([text])  # type: ignore[list-item]


def test_one_string_instead_of_a_list_is_refused(encoder: SentenceEncoder) -> None:
    with pytest.raises(InvalidInputError, match=r"give \['walk'\]"):
        encoder.embed("walk")


def test_a_model_without_a_tokenizer_says_so() -> None:
    with pytest.raises(ManifestError, match="'tmr_motion' names no tokenizer"):
        load_tokenizer(Sessions(TINY), "tmr_motion")
