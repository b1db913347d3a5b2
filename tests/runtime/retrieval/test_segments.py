"""Galleries of several segments: they answer as a gallery that was built at once, whatever became of them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder, open_fake
from first_gallery import write_first
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from motions import standing, walking

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import (
    Caption,
    Clip,
    Filter,
    Gallery,
    Search,
    build_gallery,
    find,
    growth,
    update_gallery,
)
from motionrt.retrieval.records import ModelStamp, window_table

EMBEDDER = FakeEmbedder()
STAMP = ModelStamp("fake", "f" * 64)
COLUMNS = len(ATTRIBUTES)


def gallery_of(ids: list[str], seed: int = 0) -> Gallery:
    """Clips of one to three windows with embeddings and attributes that depend on their ids alone."""
    spans, vectors, attributes = [], [], []
    for name in ids:
        random = np.random.default_rng([seed, *name.encode()])
        count = int(random.integers(1, 4))
        spans.append([(5.0 * k, 5.0 * k + 10) for k in range(count)])
        vectors.append(random.normal(size=(count, 256)))
        attributes.append(random.normal(0, 40, (count, COLUMNS)))
    stacked = np.concatenate(vectors)
    unit = (stacked / np.linalg.norm(stacked, axis=1, keepdims=True)).astype(np.float32)
    clips = tuple(Clip(name, parts[-1][1]) for name, parts in zip(ids, spans, strict=True))
    return Gallery(clips, unit, window_table(spans), STAMP, attributes=np.concatenate(attributes).astype(np.float32))


def answers(gallery: Gallery, filter: Filter | None = None) -> list[object]:  # noqa: A002
    """What a gallery says to some questions."""
    queries = EMBEDDER.embed_text(["walk", "jump", "sit"])
    said: list[object] = [
        [(hit.id, hit.start_s, hit.score) for hit in gallery.search(q, 7, per_clip=c)]
        for q in queries
        for c in (False, True)
    ]
    search = Search(k=7, anyway=True, filter=filter or Filter())
    said += [[(h.id, h.start_s, h.score) for h in find(gallery, "walk alpha left", q, search)] for q in queries]
    return said


@pytest.fixture
def many_segments(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is too small for a segment of its own."""
    monkeypatch.setattr(growth, "SMALL", 0)
    monkeypatch.setattr(growth, "_TIMES", 0)


NAMES = st.sampled_from(
    [f"{folder}{word}{n}" for folder in ("", "a/", "b/") for word in ("alpha", "beta") for n in "123"]
)


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=st.lists(st.tuples(st.booleans(), st.sets(NAMES, min_size=1, max_size=5)), min_size=1, max_size=6))
def test_any_history_of_appends_and_deletes_answers_as_a_gallery_made_at_once(
    steps: list[tuple[bool, set[str]]], tmp_path_factory: pytest.TempPathFactory, many_segments: None
) -> None:
    held = {"first", "second"}
    grown = gallery_of(sorted(held)).save(tmp_path_factory.mktemp("grown"))
    for adds, names in steps:
        if adds and names - held:
            grown = grown.append(gallery_of(sorted(names - held)))
            held |= names
        elif not adds and names & held and held - names:
            grown = grown.delete(names & held)
            held -= names
    fresh = gallery_of(sorted(held))
    assert {clip.id for clip in grown.clips} == held
    assert len(grown.windows) == len(grown.embeddings) == len(fresh.windows)
    for filters in (Filter(), Filter(where="turn > 0"), Filter(folder="a"), Filter(min_s=12, max_s=18)):
        assert answers(grown, filters) == answers(fresh, filters)
    grown.verify()
    packed = grown.compact()
    assert {path.name: path.read_bytes() for path in packed.folder.iterdir()} == {  # type: ignore[union-attr]
        path.name: path.read_bytes()
        for path in fresh.save(tmp_path_factory.mktemp("fresh")).folder.iterdir()  # type: ignore[union-attr]
    }


def test_public_arrays_of_several_segments_are_those_of_the_clips_that_are_left(
    tmp_path: Path, many_segments: None
) -> None:
    grown = gallery_of(["c", "d"]).save(tmp_path).append(gallery_of(["a", "b"])).delete(["c"])
    assert [clip.id for clip in grown.clips] == ["d", "a", "b"]
    expected = gallery_of(["d", "a", "b"])
    np.testing.assert_array_equal(grown.embeddings, expected.embeddings)
    np.testing.assert_array_equal(np.asarray(grown.attributes), expected.attributes)
    np.testing.assert_array_equal(grown.windows, expected.windows)
    for k in range(len(grown.windows)):
        np.testing.assert_array_equal(grown.embeddings[k], expected.embeddings[k])
    mask = np.arange(len(grown.windows)) % 2 == 0
    np.testing.assert_array_equal(grown.embeddings[mask], expected.embeddings[mask])
    np.testing.assert_array_equal(grown.attributes[:, 3], expected.attributes[:, 3])  # type: ignore[index]
    np.testing.assert_array_equal(grown.embeddings[-2:, 5:7], expected.embeddings[-2:, 5:7])
    np.testing.assert_allclose(grown.embeddings @ np.ones(256), expected.embeddings @ np.ones(256), atol=1e-5)
    with pytest.raises(IndexError):
        grown.embeddings[len(grown.windows)]


def test_small_segments_are_swallowed_and_large_ones_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(growth, "SMALL", 4)
    grown = gallery_of([f"a{n:03d}" for n in range(100)]).save(tmp_path)
    (large,) = tmp_path.glob("embeddings-*")
    for n in range(30):
        grown = grown.append(gallery_of([f"b{n:03d}"]))
        assert large.is_file()
    assert 2 <= len(grown.segments) <= 6
    assert [part.window_count for part in grown.segments] == sorted(
        (part.window_count for part in grown.segments), reverse=True
    )


def test_what_was_deleted_is_dropped_when_it_is_most_of_a_segment(tmp_path: Path, many_segments: None) -> None:
    ids = [f"a{n}" for n in range(9)]
    grown = gallery_of(ids).save(tmp_path).delete(ids[:3])
    assert len(grown.segments[0].clips) == 9
    grown = grown.delete(ids[3:5])
    assert len(grown.segments[0].clips) == 4
    with pytest.raises(InvalidInputError, match="no clip 'a0'"):
        grown.delete(["a0"])
    with pytest.raises(InvalidInputError, match="at least one clip"):
        grown.delete(ids[5:])


def test_an_append_refuses_ids_that_are_taken_other_models_and_half_of_the_motions(tmp_path: Path) -> None:
    grown = gallery_of(["a", "b"]).save(tmp_path)
    with pytest.raises(InvalidInputError, match="a clip 'b' already"):
        grown.append(gallery_of(["b", "c"]))
    with pytest.raises(GalleryError, match="embedded by other"):
        grown.append(replace(gallery_of(["c"]), model=ModelStamp("other", "0" * 64)))
    with pytest.raises(InvalidInputError, match="carry their motions"):
        grown.append(Gallery.from_motions([standing(5)], ["c"], EMBEDDER))
    with pytest.raises(InvalidInputError, match="save it first"):
        gallery_of(["a"]).append(gallery_of(["b"]))


def test_motions_of_all_segments_are_found(tmp_path: Path, many_segments: None) -> None:
    first = Gallery.from_motions([standing(4), walking(9)], ["stand", "walk"], EMBEDDER, texts=["s", "w"]).save(
        tmp_path
    )
    grown = first.append(Gallery.from_motions([walking(7)], ["more"], EMBEDDER)).delete(["stand"])
    for compacted in (False, True):
        gallery = grown.compact() if compacted else grown
        assert {name: gallery.motion(name).frames for name in ("walk", "more")} == {"walk": 9, "more": 7}
        assert {clip.id: clip.text for clip in gallery.clips} == {"walk": "w", "more": None}
        with pytest.raises(InvalidInputError, match="no clip 'stand'"):
            gallery.motion("stand")


@pytest.mark.parametrize(("precision", "bytes_each", "apart"), [("float16", 512, 5e-4), ("int8", 260, 4e-3)])
def test_fewer_bits_take_less_room_and_find_nearly_the_same(
    precision: str, bytes_each: int, apart: float, tmp_path: Path, many_segments: None
) -> None:
    plain = gallery_of([f"a{n:03d}" for n in range(200)])
    packed = plain.save(tmp_path).compact(precision)
    (file,) = tmp_path.glob("embeddings-*")
    assert file.stat().st_size - len(plain.windows) * bytes_each < 1024
    assert np.abs(np.asarray(packed.embeddings) - plain.embeddings).max() < apart
    assert Gallery.open(tmp_path).precision == precision
    for query in EMBEDDER.embed_text(list("abcdef")):
        found, exact = ([hit.id for hit in gallery.search(query, 10)] for gallery in (packed, plain))
        assert len(set(found) & set(exact)) >= 9
        scores = np.asarray(packed.embeddings) @ query
        assert packed.search(query, 1)[0].score == pytest.approx(scores.max(), abs=1e-6)
    before = file.read_bytes()
    packed.append(gallery_of(["b"])).delete(["b"]).compact()
    assert file.read_bytes() == before  # what is packed is never packed again
    with pytest.raises(InvalidInputError, match="float32, float16, int8"):
        packed.compact("int4")


def test_the_files_are_safetensors_that_its_own_package_reads(tmp_path: Path) -> None:
    reader = pytest.importorskip("safetensors.numpy", reason="safetensors is not installed")
    gallery = replace(gallery_of(["a", "b/c"]), captions=(Caption("b/c", "a waltz", 1.0, None, ("dance", "slow")),))
    gallery.save(tmp_path)
    read = {path.name.partition("-")[0]: reader.load_file(path) for path in tmp_path.glob("*.safetensors")}
    assert set(read) == {"clips", "embeddings", "attributes", "captions", "words"}
    np.testing.assert_array_equal(read["embeddings"]["vectors"], gallery.embeddings)
    np.testing.assert_array_equal(read["attributes"]["attributes"].T, gallery.attributes)
    assert read["clips"]["ids"].tobytes() == b"ab/c"
    assert read["clips"]["id_ends"].tolist() == [1, 4]
    assert read["clips"]["windows"].view(gallery.windows.dtype).tolist() == [[row] for row in gallery.windows.tolist()]
    assert read["captions"]["texts"].tobytes() == b"a waltz"
    assert read["captions"]["start_s"].tolist() == [1.0]
    assert Gallery.open(tmp_path).captions == gallery.captions


def test_a_gallery_of_the_first_version_opens_answers_alike_and_is_brought_up_to_date(tmp_path: Path) -> None:
    told = (Caption("b/beta", "a slow waltz", tags=("dance",)), Caption("c", "alpha", 0.0, 4.0))
    gallery = replace(gallery_of(["a", "b/beta", "c"]), captions=told)
    folder = write_first(gallery, tmp_path / "old")
    old = Gallery.open(folder)
    old.verify()
    assert old.clips == gallery.clips
    assert old.captions == told
    assert answers(old) == answers(gallery)
    new = old.compact()
    assert json.loads((folder / "gallery.json").read_text())["version"] == 2
    assert answers(new) == answers(gallery)
    assert not list(folder.glob("*.npy"))
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        path.name
        for path in gallery.save(tmp_path / "new").folder.iterdir()  # type: ignore[union-attr]
    )


def test_an_update_migrates_a_gallery_of_the_first_version_without_reading_a_file(tmp_path: Path) -> None:
    for name, speed in (("slow", 0.8), ("fast", 1.6)):
        walking(24, speed=speed).save(tmp_path / f"{name}.npz")
    built = build_gallery(tmp_path, open_fake).gallery
    assert built.folder is not None
    expected = {path.name: path.read_bytes() for path in built.folder.iterdir()}
    write_first(built, built.folder)
    report = update_gallery(tmp_path, open_fake)
    assert (report.indexed, report.unchanged) == (0, ("fast.npz", "slow.npz"))
    assert {path.name: path.read_bytes() for path in built.folder.iterdir()} == expected
