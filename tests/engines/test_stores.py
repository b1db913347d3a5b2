"""Libraries in real engines: the answers of the gallery that was copied into them, and has gone."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from engine_library import CLIPS, library
from engine_servers import STAMP
from fake_embedder import FakeEmbedder

from motionrt.engines import GalleryStore, copy_gallery, find_in, open_store
from motionrt.errors import GalleryError, GalleryNotFoundError, InvalidInputError
from motionrt.retrieval import Filter, Search, Weights, find
from motionrt.retrieval.records import ModelStamp, window_table
from motionrt.runtime import Runtime

EMBEDDER = FakeEmbedder()
NO_WORDS = Weights(words=0.0)


FILTERS = [
    Filter(),
    Filter(min_s=12, max_s=17),
    Filter(folder="b"),
    Filter(tags=("slow",)),
    Filter(tags=("LOOP", "quick"), folder="a/"),
    Filter(where="turn > 20 and speed < 1.5"),
    Filter(where="abs(turn) < 30 or not (duration >= 5)"),
    Filter(where="-30 < bend <= 30 and end != 'sitting'"),
    Filter(where="in_place", min_s=11),
]


def told(hits: list[object]) -> list[tuple[str, float]]:
    return [(hit.id, hit.start_s) for hit in hits]  # type: ignore[attr-defined]


@pytest.mark.parametrize("per_clip", [True, False])
def test_a_library_gives_the_answers_of_the_gallery_that_has_gone(
    store: GalleryStore, tmp_path: Path, per_clip: bool
) -> None:
    gallery = library().save(tmp_path / "gallery")
    texts = ["turns left", "walks", "jumps"]
    queries = EMBEDDER.embed_text(texts)
    searches = [Search(20, per_clip, weights=Weights(1, 0, 0), filter=one) for one in FILTERS]
    searches.append(Search(10, per_clip, weights=NO_WORDS))
    expected = [[find(gallery, text, q, one) for text, q in zip(texts, queries, strict=True)] for one in searches]
    count = len(gallery.windows)
    assert copy_gallery(gallery, store) == CLIPS
    del gallery
    shutil.rmtree(tmp_path / "gallery")
    assert len(store) == count
    for search, wanted in zip(searches, expected, strict=True):
        found = find_in(store, texts, queries, search)
        assert [told(hits) for hits in found] == [told(hits) for hits in wanted], search.filter
        for hits, others in zip(found, wanted, strict=True):
            np.testing.assert_allclose([h.score for h in hits], [h.score for h in others], atol=1e-6)
            assert [hit.text for hit in hits] == [hit.text for hit in others]


def test_an_upsert_replaces_clips_and_drops_the_windows_that_they_no_longer_have(store: GalleryStore) -> None:
    whole = library(30)
    store.upsert(whole)
    store.upsert(whole)
    assert len(store) == len(whole.windows)
    firsts = np.unique(whole.windows["clip"], return_index=True)[1]
    short = replace(
        whole,
        embeddings=np.asarray(whole.embeddings)[firsts][:, ::-1].copy(),
        windows=window_table([[(1.0, 2.0)]] * 30),
        attributes=np.asarray(whole.attributes)[firsts],
    )
    store.upsert(short)
    assert len(store) == 30
    (found,) = store.nearest(short.embeddings[7:8], 1, Filter())
    assert (found.clips[0], found.spans[0].tolist()) == (whole.clips[7].id, [1.0, 2.0])
    np.testing.assert_array_equal(found.embeddings[0], short.embeddings[7])
    np.testing.assert_array_equal(found.attributes[0], short.attributes[7])  # type: ignore[index]


def test_deleted_clips_are_found_no_more_and_may_be_deleted_again(store: GalleryStore) -> None:
    whole = library(30)
    store.upsert(whole)
    gone = [clip.id for clip in whole.clips[:10]]
    for _ in range(2):
        store.delete([*gone, "never there"])
    (found,) = store.nearest(whole.embeddings[:1], 1000, Filter())
    assert set(found.clips) == {clip.id for clip in whole.clips[10:]}


def test_what_was_put_in_is_there_when_it_is_opened_again(address: str) -> None:
    store = open_store(address, STAMP)
    store.upsert(library(20))
    store.close()
    again = open_store(address)
    assert again.model == STAMP
    (found,) = again.nearest(library(20).embeddings[3:4], 5, Filter(tags=("slow",)))
    assert len(found.clips) == 5
    again.close()


def test_a_library_that_is_not_there_is_told_and_another_models_clips_are_refused(address: str) -> None:
    with pytest.raises(GalleryNotFoundError, match="motionrt gallery copy"):
        open_store(address)
    store = open_store(address, STAMP)
    with pytest.raises(GalleryError, match="embedded by"):
        copy_gallery(replace(library(3), model=ModelStamp("other", "0" * 64)), store)
    store.close()


def test_the_runtime_searches_a_library_by_its_address_or_as_a_store(address: str) -> None:
    runtime = Runtime()
    vars(runtime)["model"] = EMBEDDER
    store = open_store(address, STAMP)
    store.upsert(library())
    by_address = runtime.retrieve(["walks", "jumps"], 5, address)
    by_store = runtime.retrieve(["walks", "jumps"], 5, store)
    assert [told(hits) for hits in by_address] == [told(hits) for hits in by_store]
    assert [len(hits) for hits in by_store] == [5, 5]
    assert runtime.retrieve("walks", 5, store, filter=Filter(min_s=99)).notice
    vars(runtime)["model"] = FakeEmbedder("0" * 64, "another")
    with pytest.raises(GalleryError, match="not by another"):
        runtime.retrieve("walks", 5, store)
    store.close()
    for opened in vars(runtime)["_stores"].values():
        opened.close()


def test_what_an_engine_cannot_say_is_refused(store: GalleryStore) -> None:
    query = EMBEDDER.embed_text(["x"])
    with pytest.raises(InvalidInputError, match="words"):
        store.nearest(query, 3, Filter(text="pirate"))


@pytest.mark.parametrize("name", ["with space", "x;drop table y", "", "1a", "é"])
def test_names_of_libraries_are_plain(name: str, request: pytest.FixtureRequest) -> None:
    postgres = request.getfixturevalue("postgres")
    with pytest.raises(InvalidInputError, match="a library is named"):
        open_store(f"{postgres.address}#{name or '-'}", STAMP)


def test_an_address_of_nothing_known_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="no address of a store"):
        open_store("redis://localhost")


def test_the_command_line_copies_and_searches(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from motionrt.cli import main
    from motionrt.services import search

    monkeypatch.setattr(search, "TextMotionModel", lambda *_, **__: EMBEDDER)
    gallery = library(30).save(tmp_path / "gallery")
    assert main(["gallery", "copy", str(gallery.folder), address]) == 0
    assert f"30 clips copied; the library holds {len(gallery.windows)} windows" in capsys.readouterr().out
    assert main(["retrieve", "walks", "--gallery", address, "-k", "3"]) == 0
    best = find(gallery, "walks", EMBEDDER.embed_text(["walks"])[0], Search(3, weights=NO_WORDS))[0].id
    assert best in capsys.readouterr().out
    assert main(["retrieve", "walks", "--gallery", address, "--save", str(tmp_path / "out")]) == 1
    assert "holds no motions" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["caf\udce9.bvh", "a\nb.bvh", "a\0b.bvh"])
def test_names_that_no_database_takes_are_refused(store: GalleryStore, name: str) -> None:
    one = library(1)
    with pytest.raises(InvalidInputError, match="rename the file"):
        store.upsert(replace(one, clips=(replace(one.clips[0], id=name),), captions=()))
