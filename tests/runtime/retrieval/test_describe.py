"""Captions for a motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder
from motions import standing, walking

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.retrieval import EmbeddedCaptions, checked_captions, describe, motion_features, read_captions
from motionrt.retrieval.describing import SWING, swing_penalties


def test_the_caption_nearest_to_any_window_comes_first_with_that_window() -> None:
    walk, still = walking(200), standing(200)
    motion = Motion(
        np.concatenate([walk.rotations, still.rotations]),
        np.concatenate([walk.root, np.tile(walk.root[-1], (200, 1))]),
        20.0,
    )
    model, features = FakeEmbedder(), motion_features(motion)
    vectors = np.stack([model.embed_text(["nonsense"])[0], model.embed_motion([features[200:]])[0]])
    captions = EmbeddedCaptions(("nonsense", "stand"), vectors, model.fingerprint)
    found = describe(features, motion.duration, captions, model, k=9)
    assert [(d.rank, d.text) for d in found] == [(1, "stand"), (2, "nonsense")]
    assert (found[0].start_s, found[0].end_s) == (10.0, 20.0)
    assert found[0].score == pytest.approx(1.0, abs=1e-5)


def test_captions_are_read_without_comments_blank_lines_and_repeats(tmp_path: Path) -> None:
    path = tmp_path / "captions.txt"
    path.write_text("\ufeff# mine\nwalk\n\n  tanzt fröhlich  \nwalk\n", encoding="utf-8")
    assert read_captions(path) == ["walk", "tanzt fröhlich"]


@pytest.mark.parametrize("content", [b"\n# nothing\n", b"\xff\xfe\x00w"])
def test_a_file_without_captions_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "captions.txt"
    path.write_bytes(content)
    with pytest.raises(InvalidInputError, match=r"captions"):
        read_captions(path)


@pytest.mark.parametrize("captions", ["walk", [], [1]])
def test_a_caption_list_must_be_a_list_of_texts(captions: object) -> None:
    with pytest.raises(InvalidInputError, match="list"):
        checked_captions(captions)  # type: ignore[arg-type]


def test_embedded_captions_come_back_for_the_model_that_made_them(tmp_path: Path) -> None:
    texts = ("walk", "tanzt fröhlich, ganz allein")
    vectors = FakeEmbedder().embed_text(texts)
    path = EmbeddedCaptions(texts, vectors, "f" * 64).save(tmp_path / "captions.npz")
    found = EmbeddedCaptions.read(path, "f" * 64)
    assert found is not None
    assert found.texts == texts
    np.testing.assert_allclose(found.embeddings, vectors, atol=5e-4)
    assert EmbeddedCaptions.read(path, "0" * 64) is None


@pytest.mark.parametrize("content", [None, b"", b"PK nothing"])
def test_embedded_captions_that_cannot_be_read_are_none(content: bytes | None, tmp_path: Path) -> None:
    path = tmp_path / "captions.npz"
    if content is not None:
        path.write_bytes(content)
    assert EmbeddedCaptions.read(path, "f" * 64) is None


def test_a_fast_foot_kicks_and_a_slow_one_is_lifted() -> None:
    texts = (
        "kick high",
        "lift the left leg",
        "raise the right arm",
        "walk",
        "raise the left knee",
        "lift a box",
    )
    slow = measure(walking(40))
    fast = replace(slow, left_foot_peak=5.5)
    even = replace(slow, left_foot_peak=3.5, right_foot_peak=1.0)
    assert slow.left_foot_peak < 3.0
    np.testing.assert_allclose(swing_penalties(texts, slow), [SWING, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(swing_penalties(texts, fast), [0, SWING, 0, 0, SWING, 0])
    assert not swing_penalties(texts, even).any()
