"""The models that ship: every file as the manifest says, and a sentence encoder that knows what is alike."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.errors import ModelFileError
from motionrt.models import Manifest, SentenceEncoder, Sessions, TextMotionModel, find_manifest, load_manifest, verify
from motionrt.retrieval import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS


@pytest.fixture(scope="module")
def manifest() -> Manifest:
    try:
        return load_manifest(find_manifest())
    except ModelFileError as error:
        pytest.skip(f"no models here: {error}")


def test_every_shipped_file_is_whole(manifest: Manifest) -> None:
    reports = verify(manifest)
    assert [report for report in reports if not report.ok] == []
    assert {r.model for r in reports} >= {"tmr_text", "tmr_motion", "tmr_decoder"}


def test_sizes_and_licences_are_told(manifest: Manifest) -> None:
    for model in manifest.models.values():
        variant = model.variant()
        if variant.shipped:
            assert manifest.locate(variant.file).stat().st_size == variant.bytes
        assert model.licence
        assert model.training_data
    assert sum(model.variant().shipped for model in manifest.models.values()) >= 8


def test_measured_parity_is_within_the_promise(manifest: Manifest) -> None:
    for model in manifest.models.values():
        for variant in model.variants.values():
            for output, limits in variant.tolerance.items():
                for name, limit in limits.items():
                    found = variant.parity[output][name]
                    assert found >= limit if name.endswith("_min") else found <= limit


def test_sessions_take_and_give_what_the_manifest_says(manifest: Manifest) -> None:
    sessions = Sessions(manifest.path, threads=1)
    kinds = {"tensor(float)": "float32", "tensor(int64)": "int64", "tensor(bool)": "bool"}
    built = [model for model in manifest.models.values() if manifest.locate(model.variant().file).is_file()]
    assert {model.name for model in built} >= {m.name for m in manifest.models.values() if m.variant().shipped}
    for model in built:
        session = sessions.session(model.name)
        for found, told in ((session.get_inputs(), model.inputs), (session.get_outputs(), model.outputs)):
            assert [(x.name, kinds[x.type], tuple(x.shape)) for x in found] == [
                (x.name, x.dtype, x.shape) for x in told
            ]


def test_sentences_of_one_meaning_are_nearer_than_others(manifest: Manifest) -> None:
    encoder = SentenceEncoder(Sessions(manifest.path, threads=1))
    walk, walking, throw = encoder.embed(
        ["a person walks forward", "somebody is walking straight ahead", "a man throws a ball overhand"]
    )
    assert walk @ walking > 0.7 > walk @ throw


def test_the_small_text_tower_says_what_the_full_one_does(manifest: Manifest) -> None:
    """It was distilled from this one, and not from another: alike, and nearest to itself among sixty captions."""
    if "tmr_student" not in manifest.models:
        pytest.skip("the models have no small text tower yet")
    texts = read_captions(DEFAULT_CAPTIONS)[::12]
    small, full = (
        TextMotionModel(manifest.path, threads=1, text_tower=tower).embed_text(texts) for tower in ("small", "full")
    )
    assert (small * full).sum(axis=1).mean() > 0.85
    ranks = [(row > row[index]).sum() for index, row in enumerate(small @ full.T)]
    assert np.mean([rank < 3 for rank in ranks]) > 0.8


def test_a_text_and_a_decoded_motion_go_round(manifest: Manifest) -> None:
    decoder = manifest.variant("tmr_decoder")
    if not manifest.locate(decoder.file).is_file():
        pytest.skip(f"{decoder.file} is not shipped, and not built here: python -m motionrt_export all")
    model = TextMotionModel(manifest.path, threads=1)
    motion = model.decode(model.text_latents(["a person walks forward"]), 60)
    assert np.isfinite(motion).all()
    assert model.embed_motion(list(motion)) @ model.embed_text(["a person walks forward"])[0] > 0.3
