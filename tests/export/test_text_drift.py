"""Texts one by one, as the runtime feeds them: equal files have no drift, and a damaged one is found."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import TinySources, tiny_sources

from motionrt_export.measures import beyond
from motionrt_export.references import Reference
from motionrt_export.text_drift import TextDrift
from motionrt_export.tolerances import tolerance

LIMITS = {"alone": tolerance("tmr_text", "int8")["alone"]}
TEXTS = ("walk", "turn left", "a person jumps over a fence")


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> TinySources:
    sources = tiny_sources(tmp_path_factory.mktemp("checkpoints"))
    sources.every = 150
    return sources


def damaged(reference: Reference, noise: float, only: int | None = None) -> Reference:
    """Embeddings with noise, of every length of text or of one."""

    def run(feeds: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        found = reference(feeds)["embedding"]
        hit = only is None or feeds["input_ids"].shape[1] == only
        return {"embedding": found + hit * noise * np.random.default_rng(0).standard_normal(found.shape)}

    return run


def test_texts_beside_themselves_do_not_drift(sources: TinySources) -> None:
    source = sources.source("tmr_text")
    assert source.trial is not None
    figures = source.trial(source.reference, source.reference)
    assert figures["alone"]["cosine_min"] == pytest.approx(1.0, abs=1e-6)
    assert not beyond(figures, LIMITS)


def test_a_damaged_file_is_beyond_the_tolerance(sources: TinySources) -> None:
    source = sources.source("tmr_text")
    assert source.trial is not None
    assert beyond(source.trial(damaged(source.reference, 0.02), source.reference), LIMITS)


def test_one_bad_text_is_enough() -> None:
    def encode(text: str) -> list[int]:
        return [101, *(len(word) for word in text.split()), 102]

    def exact(feeds: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        assert feeds["input_ids"].shape[0] == 1
        assert feeds["attention_mask"].all()
        return {"embedding": np.random.default_rng(feeds["input_ids"].sum()).standard_normal((1, 256))}

    trial = TextDrift(encode, TEXTS)
    figures = trial(damaged(exact, 0.5, only=8), exact)
    assert beyond(figures, LIMITS)
    assert not beyond(trial(damaged(exact, 0.5, only=99), exact), LIMITS)
