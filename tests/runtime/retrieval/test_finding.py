"""Search with attributes, words and filters beside the embedding."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder, open_fake
from first_gallery import write_first
from motions import walking

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import (
    EMBEDDING_ONLY,
    Caption,
    Filter,
    Gallery,
    Search,
    Weights,
    build_gallery,
    duplicates,
    find,
    grouped,
    similar,
    update_gallery,
)
from motionrt.retrieval.columns import Columns
from motionrt.retrieval.ranking import combined
from motionrt.retrieval.where import condition
from motionrt.retrieval.words import WordIndex, stems

EMBEDDER = FakeEmbedder()


@pytest.fixture(scope="module")
def gallery() -> Gallery:
    left = walking(90, turn=0.9)
    clips = {"left": left, "left_mirror": left.mirror(), "straight": walking(90), "slow": walking(200)}
    return Gallery.from_motions(list(clips.values()), list(clips), EMBEDDER)


def _ask(gallery: Gallery, text: str, **options: object) -> list[str]:
    return [hit.id for hit in find(gallery, text, EMBEDDER.embed_text([text])[0], Search(**options))]  # type: ignore[arg-type]


def _turns(gallery: Gallery) -> dict[str, float]:
    turn = gallery.attributes[:, ATTRIBUTES.index("turn")]  # type: ignore[index]
    return {clip.id: float(turn[list(gallery.windows["clip"]).index(n)]) for n, clip in enumerate(gallery.clips)}


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("text", ["turns to the {}", "walks along a curve to the {}", "a person goes in a circle {}"])
def test_a_query_with_a_side_ranks_the_mirror_image_below_its_clip(gallery: Gallery, text: str, side: str) -> None:
    turn = _turns(gallery)
    assert turn["left"] == pytest.approx(-turn["left_mirror"], abs=0.5)
    right_way = max(("left", "left_mirror"), key=lambda clip: turn[clip] * (1 if side == "left" else -1))
    wrong_way = {"left": "left_mirror", "left_mirror": "left"}[right_way]
    found = _ask(gallery, text.format(side))
    assert found.index(right_way) < found.index(wrong_way)


def test_the_embedding_alone_gives_the_cosine(gallery: Gallery) -> None:
    query = EMBEDDER.embed_text(["walks"])[0]
    found = find(gallery, "walks", query, Search(weights=EMBEDDING_ONLY))
    plain = gallery.search(query)
    assert [(hit.id, hit.score) for hit in found] == [(hit.id, hit.score) for hit in plain]
    assert all(hit.score == pytest.approx(hit.cosine) for hit in found)


def test_the_score_is_the_weighted_sum() -> None:
    cosines, fits, words = np.array([0.5, 0.1]), np.array([0.0, 1.0]), np.array([1.0, 0.0])
    total = combined(cosines, fits, words, Weights(2.0, 0.4, 0.3))
    assert total == pytest.approx([1.0 - 0.2 + 0.3, 0.2 + 0.2])
    assert combined(cosines, None, None, Weights()) == pytest.approx(cosines)


def test_words_of_the_library_find_their_clip(gallery: Gallery) -> None:
    from dataclasses import replace

    told = replace(gallery, captions=(Caption("slow", "an astronaut drifts through an airlock", tags=("space",)),))
    assert _ask(told, "astronaut airlock", weights=Weights(words=2.0))[0] == "slow"
    assert _ask(told, "walks", filter=Filter(tags=("Space",))) == ["slow"]
    assert find(gallery, "astronaut airlock", EMBEDDER.embed_text(["x"])[0], Search()).notice is not None
    assert find(told, "astronaut airlock", EMBEDDER.embed_text(["x"])[0], Search()).notice is None


def test_rare_words_weigh_more_and_all_words_most(gallery: Gallery) -> None:
    captions = [Caption(clip.id, "walks") for clip in gallery.clips] + [Caption("slow", "limping")]
    index = WordIndex.of(gallery.clips, gallery.windows, captions, names=False)
    scores = index.scores("limping walks")
    assert scores is not None
    slow = [gallery.clips[int(row["clip"])].id == "slow" for row in gallery.windows]
    assert scores[slow].min() > scores[~np.array(slow)].max() >= 0
    assert index.scores("helicopter") is None


def test_a_caption_of_a_part_belongs_to_the_windows_there(gallery: Gallery) -> None:
    windows = np.array([(0, 0, 10), (0, 5, 15), (0, 10, 20)], dtype=gallery.windows.dtype)
    index = WordIndex.of(gallery.clips[:1], windows, [Caption(gallery.clips[0].id, "sneeze", 12, 19)], names=False)
    scores = index.scores("sneezing")
    assert scores is not None
    assert (scores > 0).tolist() == [False, False, True]


def test_endings_do_not_matter() -> None:
    assert stems("Waving waves wave, hopped HOPS hop carries") == stems("wave wave wave hop hop hop carry")
    assert stems("walkLeft_final-02") == ["walk", "left", "final"]
    assert stems("a person does the") == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("turn > 60", lambda c: c["turn"] > 60),
        ("turn > 60 and speed < 1.5", lambda c: (c["turn"] > 60) & (c["speed_mean"] < 1.5)),
        ("not (duration >= 5) or left < -1", lambda c: ~(c["seconds"] >= 5) | (c["walk_left"] < -1)),
        ("-30 < turn <= 30", lambda c: (c["turn"] > -30) & (c["turn"] <= 30)),
        ("abs(turn) + 2 * bend / 3 > 10", lambda c: np.abs(c["turn"]) + 2 * c["path_bend"] / 3 > 10),
        ("end == 'sitting'", lambda c: c["posture_end"] == 4),
        ("in_place and jumps != 0", lambda c: (c["farthest"] < 0.5) & (c["jumps"] != 0)),
    ],
)
def test_conditions_select_as_numpy_does(text: str, expected: object) -> None:
    table = np.random.default_rng(0).normal(0, 40, (500, len(ATTRIBUTES))).astype(np.float32)
    table[:, ATTRIBUTES.index("posture_end")] = np.arange(500) % 8
    columns = Columns(table)
    assert (condition(text)(columns) == expected(columns)).all()  # type: ignore[operator]


@pytest.mark.parametrize(
    "text",
    [
        "", "turn", "turn >", "turn > 'left'", "__import__('os')", "turn.__class__ > 1", "turn ** 9 > 1", "x > 1",
        "abs(turn, 1) > 2", "[turn] > 1", "turn > 1 if 1 else 2", "lambda: 1", "turn and speed", "'a' < 'b'",
        "turn is 1",
        "(" * 300 + "turn > 1" + ")" * 300, "turn > 1" * 200, "1 > 10**99", "turn := 1",
    ],
)  # fmt: skip
def test_what_is_no_condition_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError):
        condition(text)


def test_hits_are_grouped_by_clip_the_best_clip_first(gallery: Gallery) -> None:
    hits = find(gallery, "walks", EMBEDDER.embed_text(["walks"])[0], Search(per_clip=False))
    groups = grouped([*hits, *hits[::-1]])
    assert [group[0].id for group in groups] == list(dict.fromkeys(hit.id for hit in hits))
    assert all({hit.id for hit in group} == {group[0].id} for group in groups)
    assert sum(map(len, groups)) == 2 * len(hits)


def test_durations_that_no_clip_has_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least 5"):
        Filter(min_s=5, max_s=3)


def test_filters_hold_together(gallery: Gallery) -> None:
    assert set(_ask(gallery, "walks", filter=Filter(min_s=8))) == {"slow"}
    assert set(_ask(gallery, "walks", filter=Filter(max_s=8, where="abs(turn) < 20"))) == {"straight"}
    assert find(gallery, "walks", EMBEDDER.embed_text(["w"])[0], Search(filter=Filter(min_s=99))).notice is not None


def test_similar_and_duplicates_tell_a_clip_from_its_mirror_image(gallery: Gallery) -> None:
    number = [clip.id for clip in gallery.clips].index("left")
    row = list(gallery.windows["clip"]).index(number)
    hits = similar(gallery, gallery.embeddings[row], 10, without="left")
    assert "left" not in {hit.id for hit in hits}
    assert [hit.rank for hit in hits] == [1, 2, 3]
    assert duplicates(gallery, cosine=-1.0) == []


def test_an_old_gallery_opens_without_attributes_and_an_update_adds_them(tmp_path: Path) -> None:
    walking(40).save(tmp_path / "a.bvh")
    walking(60).save(tmp_path / "b.bvh")
    built = build_gallery(tmp_path, open_fake).gallery
    assert built.folder is not None
    write_first(built, built.folder, attributes=False)
    old = Gallery.open(tmp_path)
    assert old.attributes is None
    assert len(_ask(old, "walks to the left")) == 2
    with pytest.raises(GalleryError, match="motionrt gallery update"):
        _ask(old, "walks", filter=Filter(where="turn > 1"))
    new = update_gallery(tmp_path, open_fake).gallery
    assert new.attributes is not None
    assert new.attributes.shape == (2, len(ATTRIBUTES))
    assert np.array_equal(new.embeddings, old.embeddings)


def test_sidecars_give_captions_and_tags_and_an_update_reads_them_again(tmp_path: Path) -> None:
    (tmp_path / "walks").mkdir()
    walking(40).save(tmp_path / "walks" / "a.bvh")
    walking(60).save(tmp_path / "b.bvh")
    (tmp_path / "captions.csv").write_text("file,caption,tags\nb.bvh,a robot patrols,sci-fi; loop\nnone.bvh,x,\n")
    row = {"trial": "a", "captions": ["stroll", "an old sailor walks"], "start_s": 0.2, "end_s": 1.0}
    (tmp_path / "walks" / "captions.jsonl").write_text(json.dumps(row) + "\n")
    report = build_gallery(tmp_path, open_fake)
    assert report.gallery.captions == (
        Caption("b.bvh", "a robot patrols", tags=("sci-fi", "loop")),
        Caption("walks/a.bvh", "stroll", 0.2, 1.0),
        Caption("walks/a.bvh", "an old sailor walks", 0.2, 1.0),
    )
    assert report.gallery.skipped == ()
    assert Gallery.open(tmp_path).captions == report.gallery.captions
    (tmp_path / "captions.csv").write_text("file,caption\nb.bvh,a mule\n")
    report = update_gallery(tmp_path, open_fake)
    assert report.unchanged == ("b.bvh", "walks/a.bvh")
    assert report.gallery.captions[0] == Caption("b.bvh", "a mule")
    (tmp_path / "captions.csv").write_text("file,caption\nwrong,x\n")
    (tmp_path / "walks" / "captions.jsonl").write_text("{no json")
    skipped = update_gallery(tmp_path, open_fake).gallery.skipped
    assert [item.path for item in skipped] == ["captions.csv", "walks/captions.jsonl"]


def test_words_filter_before_the_search(gallery: Gallery) -> None:
    from dataclasses import replace

    told = replace(gallery, captions=(Caption("slow", "a pirate limps"), Caption("straight", "a pirate runs")))
    assert set(_ask(told, "walks", filter=Filter(text="pirates"))) == {"slow", "straight"}
    assert set(_ask(told, "walks", filter=Filter(text="limping pirate", min_s=8))) == {"slow"}
    assert (
        find(told, "walks", EMBEDDER.embed_text(["w"])[0], Search(filter=Filter(text="astronaut"))).notice is not None
    )


@pytest.mark.parametrize("most", [0, 10_000])
def test_a_filter_that_lets_much_pass_gives_what_a_plain_scan_gives(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    from motionrt.retrieval import Clip, finding
    from motionrt.retrieval.records import ModelStamp, window_table

    monkeypatch.setattr(finding, "_ALL", most)
    random = np.random.default_rng(3)
    vectors = random.normal(size=(6000, 256)).astype(np.float32)
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    table = random.normal(0, 40, (6000, len(ATTRIBUTES))).astype(np.float32)
    clips = tuple(Clip(f"{n:05d}", 10.0) for n in range(6000))
    spans = window_table([[(0.0, 10.0)]] * 6000)
    gallery = Gallery(clips, vectors, spans, ModelStamp("fake", "f" * 64), attributes=table).prepare()
    turn = table[:, ATTRIBUTES.index("turn")]
    for limit in (0, 60, 150):
        query = EMBEDDER.embed_text([f"walks {limit}"])[0]
        search = Search(weights=EMBEDDING_ONLY, filter=Filter(where=f"turn > {limit}"))
        passed = np.flatnonzero(turn > limit)
        best = passed[np.argsort(-(vectors[passed] @ query), kind="stable")[:10]]
        assert [hit.id for hit in find(gallery, "walks", query, search)] == [f"{n:05d}" for n in best]
