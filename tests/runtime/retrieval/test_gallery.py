"""A gallery as a value and as a folder: order, search, storage, damage, models."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder
from motions import random_motion, standing, walking

from motionrt.errors import GalleryError, GalleryNotFoundError, InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt.retrieval import Gallery, motion_features, store

MOTIONS = {
    "walk": walking(60),
    "long": random_motion(500, seed=4),
    "stand": standing(20),
    "arc": walking(90, turn=0.8),
}
TEXTS = ["a walk", "a long one", "standing", "an arc"]


@pytest.fixture
def model() -> FakeEmbedder:
    return FakeEmbedder()


@pytest.fixture
def gallery(model: FakeEmbedder) -> Gallery:
    return Gallery.from_motions(list(MOTIONS.values()), list(MOTIONS), model, texts=TEXTS)


def query_of(motion: Motion, model: FakeEmbedder) -> np.ndarray:
    return model.embed_motion([motion_features(motion)])[0]


def array_file(folder: Path, role: str) -> Path:
    return next(folder.glob(f"{role}-*"))


def test_clips_are_ordered_by_id_and_keep_their_own_texts(gallery: Gallery) -> None:
    assert [(clip.id, clip.text) for clip in gallery.clips] == [
        ("arc", "an arc"), ("long", "a long one"), ("stand", "standing"), ("walk", "a walk"),
    ]  # fmt: skip


def test_a_motion_finds_itself_first(gallery: Gallery, model: FakeEmbedder) -> None:
    hits = gallery.search(query_of(MOTIONS["arc"], model), k=2)
    assert (hits[0].rank, hits[0].id, hits[0].text, hits[0].path) == (1, "arc", "an arc", None)
    assert hits[0].score == pytest.approx(1.0, abs=1e-5)
    assert (hits[0].start_s, hits[0].end_s) == (0.0, 4.5)
    assert hits[1].rank == 2
    assert hits[1].score <= hits[0].score


def test_a_long_clip_is_found_by_its_window(gallery: Gallery, model: FakeEmbedder) -> None:
    window = guo263.part(motion_features(MOTIONS["long"]), 200, 400)
    hit = gallery.search(model.embed_motion([window])[0], k=1)[0]
    assert (hit.id, hit.start_s, hit.end_s) == ("long", 10.0, 20.0)


def test_one_hit_a_clip_unless_every_window_is_asked_for(gallery: Gallery, model: FakeEmbedder) -> None:
    query = query_of(MOTIONS["long"], model)
    assert len({hit.id for hit in gallery.search(query, k=100)}) == len(gallery) == 4
    windows = gallery.search(query, k=100, per_clip=False)
    assert len(windows) == 3 + 4  # 500 frames: at 0, 5, 10 and 15 s
    assert [hit.score for hit in windows] == sorted((hit.score for hit in windows), reverse=True)


@pytest.mark.parametrize("query", [np.zeros(3), np.zeros((1, 256))])
def test_a_query_of_the_wrong_shape_is_refused(gallery: Gallery, query: np.ndarray) -> None:
    with pytest.raises(InvalidInputError, match="vector of 256"):
        gallery.search(query)


def test_what_is_saved_is_what_is_opened(gallery: Gallery, model: FakeEmbedder, tmp_path: Path) -> None:
    opened = gallery.save(tmp_path / "gal läge")
    assert opened.clips == gallery.clips
    assert (opened.model, opened.source) == (gallery.model, None)
    np.testing.assert_array_equal(opened.embeddings, gallery.embeddings)
    np.testing.assert_array_equal(opened.windows, gallery.windows)
    query = query_of(MOTIONS["stand"], model)
    assert opened.search(query) == gallery.search(query)


def test_saving_again_gives_the_same_files_and_leaves_no_others(gallery: Gallery, tmp_path: Path) -> None:
    gallery.save(tmp_path)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    gallery.save(tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_the_embeddings_are_mapped_not_read(gallery: Gallery, tmp_path: Path) -> None:
    opened = gallery.save(tmp_path)
    base = opened.embeddings
    while isinstance(base, np.ndarray) and not isinstance(base, np.memmap):
        base = base.base
    assert isinstance(base, np.memmap)


def test_stored_motions_come_back_cut_to_the_hit(gallery: Gallery, model: FakeEmbedder, tmp_path: Path) -> None:
    opened = gallery.save(tmp_path)
    hit = opened.search(model.embed_motion([motion_features(MOTIONS["long"])[100:300]])[0], k=1)[0]
    part = opened.motion(hit)
    assert part.duration == pytest.approx(10.0)
    np.testing.assert_allclose(part.positions(), MOTIONS["long"][100:300].positions(), atol=5e-4)
    assert opened.motion("stand").frames == 20


def test_a_clip_that_is_not_there_is_an_error(gallery: Gallery) -> None:
    with pytest.raises(InvalidInputError, match="no clip 'run'"):
        gallery.motion("run")


def test_without_stored_motions_a_hit_cannot_be_loaded(model: FakeEmbedder, tmp_path: Path) -> None:
    bare = Gallery.from_motions([standing(3)], ["stand"], model, store_motions=False).save(tmp_path)
    with pytest.raises(GalleryError, match="'stand' is not in the gallery, only"):
        bare.motion("stand")


@pytest.mark.parametrize("ids", [["a", "a"], ["a"], []])
def test_ids_must_be_as_many_and_different(ids: list[str], model: FakeEmbedder) -> None:
    with pytest.raises(InvalidInputError, match="different ids"):
        Gallery.from_motions([standing(2), standing(3)], ids, model)


def test_another_models_gallery_is_refused_and_both_are_named(gallery: Gallery) -> None:
    gallery.check_model("f" * 64, "fake")
    with pytest.raises(GalleryError, match=r"made by the model fake \(ffffffffffff\), not by new \(000000000000\)"):
        gallery.check_model("0" * 64, "new")


def test_a_folder_without_a_gallery_says_how_to_build_one(tmp_path: Path) -> None:
    with pytest.raises(GalleryNotFoundError, match="motionrt gallery build") as caught:
        Gallery.open(tmp_path / "nothing here")
    assert "nothing here" in str(caught.value)


def test_damage_in_any_file_is_found(gallery: Gallery, tmp_path: Path) -> None:
    for role in ("clips", "embeddings", "attributes", "words", "motions"):
        folder = tmp_path / role
        opened = gallery.save(folder)
        opened.verify()
        content = bytearray(array_file(folder, role).read_bytes())
        content[-5] ^= 1
        array_file(folder, role).write_bytes(content)
        with pytest.raises(GalleryError, match=f"{role}.*checksum"):
            opened.verify()


@pytest.mark.parametrize("cut", [0, 30, 200])
def test_a_truncated_array_is_an_error_when_opened(gallery: Gallery, tmp_path: Path, cut: int) -> None:
    gallery.save(tmp_path)
    path = array_file(tmp_path, "embeddings")
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(GalleryError, match="damaged"):
        Gallery.open(tmp_path)


def test_a_missing_array_is_an_error_when_opened(gallery: Gallery, tmp_path: Path) -> None:
    gallery.save(tmp_path)
    array_file(tmp_path, "clips").unlink()
    with pytest.raises(GalleryError, match="damaged"):
        Gallery.open(tmp_path)


def test_a_gallery_replaced_while_it_is_opened_is_opened_anew(
    gallery: Gallery, model: FakeEmbedder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gallery.save(tmp_path)
    outdated = store.read_head(tmp_path)
    Gallery.from_motions([walking(30)], ["other"], model).save(tmp_path)
    heads = [outdated, store.read_head(tmp_path)]
    monkeypatch.setattr(store, "read_head", lambda _: heads.pop(0))
    assert [clip.id for clip in Gallery.open(tmp_path).clips] == ["other"]


def test_saving_heals_a_damaged_array(gallery: Gallery, tmp_path: Path) -> None:
    gallery.save(tmp_path)
    array_file(tmp_path, "embeddings").write_bytes(b"damaged")
    gallery.save(tmp_path).verify()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"version": 99}, "version 99"),
        ({"format": "something"}, "not a gallery"),
        ({"clips": [{"id": "only"}]}, "damaged"),
        ({"clips": []}, "damaged"),
        ({"files": {}}, "damaged"),
        ({"model": None}, "damaged"),
    ],
)
def test_a_head_that_makes_no_sense_is_an_error(
    gallery: Gallery, tmp_path: Path, change: dict[str, object], message: str
) -> None:
    gallery.save(tmp_path)
    head = json.loads((tmp_path / "gallery.json").read_text(encoding="utf-8"))
    (tmp_path / "gallery.json").write_text(json.dumps(head | change), encoding="utf-8")
    with pytest.raises(GalleryError, match=message):
        Gallery.open(tmp_path)


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff\xfe"])
def test_a_head_that_is_no_json_is_an_error(gallery: Gallery, tmp_path: Path, content: bytes) -> None:
    gallery.save(tmp_path)
    (tmp_path / "gallery.json").write_bytes(content)
    with pytest.raises(GalleryError, match="damaged"):
        Gallery.open(tmp_path)
