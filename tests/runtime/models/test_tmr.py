"""Text and motion in one space: shapes, unit length, independence of neighbours, fingerprint, refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tiny_models import TINY, edited

from motionrt.errors import InvalidInputError, ManifestError, ModelNotFoundError
from motionrt.models import Sessions, TextMotionModel
from motionrt.motion.features import guo263


@pytest.fixture(scope="module")
def model() -> TextMotionModel:
    return TextMotionModel(TINY, threads=1)


def motions(*frames: int) -> list[np.ndarray]:
    rng = np.random.default_rng(5)
    return [rng.normal(size=(count, 263)).astype(np.float32) for count in frames]


def test_embeddings_are_unit_rows(model: TextMotionModel) -> None:
    for rows in (model.embed_text(["walk", "run"]), model.embed_motion(motions(1, 77))):
        assert rows.shape == (2, 256)
        assert rows.dtype == np.float32
        np.testing.assert_allclose(np.linalg.norm(rows, axis=1), 1, atol=1e-6)


def test_a_motion_embedding_is_that_of_the_formula(model: TextMotionModel) -> None:
    """The tiny encoder is a sine of the mean features, so NumPy can do it, too."""
    motion = motions(30)[0]
    rate = np.linspace(3, 8, 256)
    rate[:4] = 20, 200, 200, 8
    latent = np.sin(motion.astype(np.float64).mean(axis=0)[:256] * rate + np.linspace(0, 40, 256))
    np.testing.assert_allclose(model.motion_latents([motion])[0], latent, atol=1e-4)
    np.testing.assert_allclose(model.embed_motion([motion])[0], latent / np.linalg.norm(latent), atol=1e-5)


def test_an_embedding_does_not_depend_on_its_neighbours(model: TextMotionModel) -> None:
    clips = motions(5, 40, 200)
    together = model.embed_motion(clips)
    for clip, row in zip(clips, together, strict=True):
        np.testing.assert_array_equal(model.embed_motion([clip])[0], row)


def test_an_embedding_is_its_latent_at_length_one() -> None:
    model = TextMotionModel(TINY, text_tower="full")
    latent = model.text_latents(["jump up"])
    np.testing.assert_allclose(
        model.embed_text(["jump up"]), latent / np.linalg.norm(latent, axis=1, keepdims=True), atol=1e-6
    )


def small_tower(ids: np.ndarray) -> np.ndarray:
    """The tiny tower is a mean of sines of the ids, so NumPy can do it, too."""
    latent = np.sin(ids[:, None] * np.linspace(0.3, 2.5, 256)).mean(axis=0)
    return np.asarray(latent / np.linalg.norm(latent))


def test_texts_are_embedded_by_the_small_tower_unless_told_otherwise(model: TextMotionModel) -> None:
    text = "a man kicks"
    expected = small_tower(model.sentences.tokens(text))
    np.testing.assert_allclose(model.embed_text([text])[0], expected, atol=2e-5)
    small, full = (TextMotionModel(TINY, text_tower=tower).embed_text([text])[0] for tower in ("small", "full"))
    np.testing.assert_array_equal(small, model.embed_text([text])[0])
    assert abs(full @ small) < 0.9


@pytest.mark.parametrize(("tower", "opened"), [(None, "tmr_student"), ("small", "tmr_student"), ("full", "tmr_text")])
def test_only_the_chosen_tower_is_opened(monkeypatch: pytest.MonkeyPatch, tower: str | None, opened: str) -> None:
    asked: set[str] = set()
    open_session = Sessions.session
    monkeypatch.setattr(Sessions, "session", lambda self, name, *a: (asked.add(name), open_session(self, name, *a))[1])
    TextMotionModel(TINY, text_tower=tower).embed_text(["walk", "run"])
    assert asked == {opened}


def test_what_is_not_embedded_opens_the_full_tower_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: set[str] = set()
    open_session = Sessions.session
    monkeypatch.setattr(Sessions, "session", lambda self, name, *a: (asked.add(name), open_session(self, name, *a))[1])
    model = TextMotionModel(TINY)
    model.text_latents(["walk"])
    model.sentences.encode("walk")
    assert asked == {"tmr_text"}


def test_models_without_a_small_tower_embed_with_the_full_one(tmp_path: Path) -> None:
    bare = edited(tmp_path, lambda c: c["models"].pop("tmr_student"))
    full = TextMotionModel(TINY, text_tower="full")
    np.testing.assert_array_equal(TextMotionModel(bare).embed_text(["walk"]), full.embed_text(["walk"]))
    with pytest.raises(ModelNotFoundError, match=r"has no small text tower \(tmr_student\); choose full"):
        TextMotionModel(bare, text_tower="small")


@pytest.mark.parametrize("tower", ["large", "", "tmr_text"])
def test_an_unknown_text_tower_is_refused(tower: str) -> None:
    with pytest.raises(InvalidInputError, match=f"there is no text tower '{tower}'; choose small or full"):
        TextMotionModel(TINY, text_tower=tower)


def test_towers_that_read_other_tokens_are_refused(tmp_path: Path) -> None:
    other = edited(tmp_path, _retold)
    with pytest.raises(ManifestError, match="tmr_student and tmr_text name different tokenizers"):
        TextMotionModel(other)
    TextMotionModel(other, text_tower="full")


def _retold(content: dict[str, Any]) -> None:
    whole = content["models"]["tmr_text"]["tokenizer"]
    content["models"]["tmr_student"]["tokenizer"] = {**whole, "max_tokens": 64}


def test_padding_changes_nothing_in_the_small_tower(model: TextMotionModel) -> None:
    ids = model.sentences.tokens("she walks to the left")[None]
    padded = np.pad(ids, ((0, 0), (0, 9)), constant_values=5)
    mask = np.pad(np.ones_like(ids), ((0, 0), (0, 9)))
    feeds = {"input_ids": padded, "attention_mask": mask}
    found = model.sessions.run("tmr_student", ["embedding"], feeds)[0]
    np.testing.assert_allclose(found, model.embed_text(["she walks to the left"]), atol=1e-6)


def test_decoding_gives_motions_that_can_be_played(model: TextMotionModel) -> None:
    features = model.decode(model.text_latents(["walk forward", "run"]), 45)
    assert features.shape == (2, 45, 263)
    motion = guo263.decode(features[0], 20.0)
    assert motion.frames == 45
    assert motion.positions()[-1, 0, 2] > motion.positions()[0, 0, 2]  # strolls towards +Z


def test_nothing_gives_nothing(model: TextMotionModel) -> None:
    assert model.embed_text([]).shape == (0, 256)
    assert model.embed_motion([]).shape == (0, 256)
    assert model.decode(np.zeros((0, 256), np.float32), 7).shape == (0, 7, 263)


def test_float64_and_strided_features_are_taken(model: TextMotionModel) -> None:
    clip = motions(40)[0]
    expected = model.embed_motion([clip[::2]])
    np.testing.assert_array_equal(model.embed_motion([clip[::2].astype(np.float64)]), expected)


@pytest.mark.parametrize("shape", [(0, 263), (5, 262), (263,), (1, 5, 263)])
def test_features_of_another_shape_are_refused(model: TextMotionModel, shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match=r"motion 1: expected guo263 features \(F, 263\), found shape"):
        model.embed_motion([motions(3)[0], np.zeros(shape, np.float32)])


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_features_that_are_not_finite_are_refused(model: TextMotionModel, value: float) -> None:
    clip = motions(9)[0]
    clip[4, 100] = value
    with pytest.raises(InvalidInputError, match=r"motion 0: .*not finite"):
        model.embed_motion([clip])


@pytest.mark.parametrize("frames", [0, -3, 2.5, True])
def test_a_wrong_number_of_frames_is_refused(model: TextMotionModel, frames: Any) -> None:
    with pytest.raises(InvalidInputError, match="frames must be a whole number from 1"):
        model.decode(np.zeros((1, 256), np.float32), frames)


def test_latents_of_another_width_are_refused(model: TextMotionModel) -> None:
    with pytest.raises(InvalidInputError, match=r"expected latents \(N, 256\)"):
        model.decode(np.zeros((1, 255), np.float32), 5)


def test_sessions_can_be_shared(model: TextMotionModel) -> None:
    sessions = Sessions(TINY, threads=1)
    first, second = TextMotionModel(sessions), TextMotionModel(sessions)
    assert first.sessions is second.sessions
    np.testing.assert_array_equal(first.embed_text(["walk"]), model.embed_text(["walk"]))


def test_equal_models_have_equal_fingerprints(model: TextMotionModel) -> None:
    assert len(model.fingerprint) == 64
    assert model.fingerprint == TextMotionModel(TINY).fingerprint


def test_galleries_serve_both_text_towers(model: TextMotionModel, tmp_path: Path) -> None:
    """What embeds texts is no part of the fingerprint: a gallery holds embeddings of motions."""
    assert {TextMotionModel(TINY, text_tower=tower).fingerprint for tower in ("small", "full")} == {model.fingerprint}
    other = edited(tmp_path, lambda c: c["models"]["tmr_student"]["variants"]["tiny"].update(sha256="a" * 64))
    assert TextMotionModel(other).fingerprint == model.fingerprint


@pytest.mark.parametrize("name", ["tmr_text", "tmr_motion"])
def test_another_encoder_has_another_fingerprint(model: TextMotionModel, tmp_path: Path, name: str) -> None:
    other = edited(tmp_path, lambda c: c["models"][name]["variants"]["tiny"].update(sha256="a" * 64))
    assert TextMotionModel(other).fingerprint != model.fingerprint


def test_the_decoder_is_no_part_of_the_fingerprint(model: TextMotionModel, tmp_path: Path) -> None:
    other = edited(tmp_path, lambda c: c["models"]["tmr_decoder"]["variants"]["tiny"].update(sha256="a" * 64))
    assert TextMotionModel(other).fingerprint == model.fingerprint


def test_another_variant_has_another_fingerprint(model: TextMotionModel, tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda c: [m["variants"]["fp32"].update(sha256="b" * 64) for m in c["models"].values()])
    assert TextMotionModel(manifest, variant="fp32").fingerprint != model.fingerprint


def test_an_unknown_variant_is_refused() -> None:
    with pytest.raises(ModelNotFoundError, match="no variant 'int4'"):
        TextMotionModel(TINY, variant="int4").embed_text(["walk"])
