"""Approximate search: what it finds, when it is exact, where its graph is kept; with faiss-cpu and without."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from motionrt.errors import InvalidInputError, MissingDependencyError
from motionrt.retrieval import Clip, Gallery, approximate
from motionrt.retrieval.approximate import WORTHWHILE_FROM, ApproximateIndex
from motionrt.retrieval.records import ModelStamp, window_table
from motionrt.retrieval.search import ExactIndex

COUNT, WIDTH = 3000, 32


class FakeGraph:
    """Finds by products of rounded vectors, and never sees the last ``blind`` of them."""

    blind = 0

    def __init__(self, width: int = WIDTH) -> None:
        self.d, self.ntotal = width, 0

    def train(self, vectors: np.ndarray) -> None:
        assert len(vectors) > 0

    def add(self, vectors: np.ndarray) -> None:
        self.vectors = np.round(vectors * 64)
        self.ntotal = len(vectors)

    def search(self, query: np.ndarray, count: int, params: object) -> tuple[None, np.ndarray]:
        seen = self.vectors[: self.ntotal - self.blind]
        found = np.full((1, count), -1)
        best = np.argsort(-(seen @ query[0]))[:count]
        found[0, : len(best)] = best
        return None, found


class FakeFaiss(SimpleNamespace):
    METRIC_L2 = 1
    IndexPreTransform = type(None)
    SearchParametersHNSW = SimpleNamespace
    built = 0

    def index_factory(self, width: int, kind: str, metric: int) -> FakeGraph:
        self.built += 1
        return FakeGraph(width)

    def write_index(self, graph: FakeGraph, path: str) -> None:
        with Path(path).open("wb") as file:
            np.save(file, graph.vectors)

    def read_index(self, path: str) -> FakeGraph:
        try:
            vectors = np.load(path)
        except (ValueError, EOFError) as error:
            raise RuntimeError from error
        graph = FakeGraph(vectors.shape[1])
        graph.vectors, graph.ntotal = vectors, len(vectors)
        return graph


@pytest.fixture
def faiss(monkeypatch: pytest.MonkeyPatch) -> FakeFaiss:
    fake = FakeFaiss()
    monkeypatch.setitem(sys.modules, "faiss", fake)
    monkeypatch.setattr(approximate, "WORTHWHILE_FROM", 100)
    return fake


def clustered(count: int, width: int, seed: int = 0) -> np.ndarray:
    """Unit vectors around many centres, most of their spread in few directions, as embeddings of motion have it."""
    random = np.random.default_rng(seed)
    centres = random.normal(size=(200, width)) * 0.9 ** np.arange(width)
    vectors = centres[random.integers(0, 200, count)]
    vectors += 0.3 * random.normal(size=(count, width)) * 0.9 ** np.arange(width)
    return (vectors / np.linalg.norm(vectors, axis=1, keepdims=True)).astype(np.float32)


def gallery_of(vectors: np.ndarray) -> Gallery:
    clips = tuple(Clip(f"{number:05d}", 10.0) for number in range(len(vectors) // 2))
    windows = window_table([[(0.0, 10.0), (5.0, 15.0)]] * len(clips))
    return Gallery(clips, vectors, windows, ModelStamp("fake", "f" * 64))


def graphs(folder: Path) -> list[Path]:
    return sorted(folder.glob("neighbours-*.faiss"))


def test_hits_have_the_scores_of_float32_best_first(faiss: FakeFaiss) -> None:
    vectors = clustered(COUNT, WIDTH)
    index = ApproximateIndex(vectors, ExactIndex(vectors))
    query = clustered(1, WIDTH, seed=1)[0]
    found, scores = index.nearest(query, 10)
    assert faiss.built == 1
    assert scores.tolist() == sorted(scores.tolist(), reverse=True)
    np.testing.assert_array_equal(scores, np.einsum("nd,d->n", vectors, query)[found])
    assert len(set(found.tolist())) == 10


def test_a_small_set_and_a_question_for_very_many_are_answered_exactly(
    faiss: FakeFaiss, monkeypatch: pytest.MonkeyPatch
) -> None:
    vectors = clustered(COUNT, WIDTH)
    exact = ExactIndex(vectors)
    np.testing.assert_array_equal(
        ApproximateIndex(vectors, exact).nearest(vectors[0], 2500)[0], exact.nearest(vectors[0], 2500)[0]
    )
    monkeypatch.setattr(approximate, "WORTHWHILE_FROM", WORTHWHILE_FROM)
    np.testing.assert_array_equal(
        ApproximateIndex(vectors, exact).nearest(vectors[0], 5)[0], exact.nearest(vectors[0], 5)[0]
    )
    assert faiss.built == 0


def test_a_graph_that_finds_too_few_is_not_believed(faiss: FakeFaiss, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FakeGraph, "blind", COUNT - 5)
    vectors = clustered(COUNT, WIDTH)
    found, _ = ApproximateIndex(vectors, ExactIndex(vectors)).nearest(vectors[-1], 10)
    assert found[0] == COUNT - 1
    assert len(found) == 10


def test_a_gallery_keeps_its_graph_and_opens_it_again(faiss: FakeFaiss, tmp_path: Path) -> None:
    saved = gallery_of(clustered(COUNT, WIDTH)).save(tmp_path)
    query = saved.embeddings[41]
    hits = saved.search(query, 5, approximate=True)
    assert hits[0].id == "00020"
    assert len({hit.id for hit in hits}) == 5
    assert len(graphs(tmp_path)) == 1
    assert Gallery.open(tmp_path).search(query, 5, approximate=True) == hits
    assert Gallery.open(tmp_path).prepare(approximate=True).search(query, 5, approximate=True) == hits
    assert faiss.built == 1
    assert not list(tmp_path.glob(".writing-*"))


def test_a_changed_gallery_gets_a_new_graph_and_the_old_one_goes(faiss: FakeFaiss, tmp_path: Path) -> None:
    gallery_of(clustered(COUNT, WIDTH)).save(tmp_path).prepare(approximate=True)
    before = graphs(tmp_path)
    gallery_of(clustered(COUNT, WIDTH)).save(tmp_path)
    assert graphs(tmp_path) == before  # the same embeddings, the same graph
    changed = gallery_of(clustered(COUNT, WIDTH, seed=5)).save(tmp_path)
    assert graphs(tmp_path) == []
    assert changed.search(changed.embeddings[6], 1, approximate=True)[0].id == "00003"
    assert graphs(tmp_path) != before
    assert faiss.built == 2


@pytest.mark.parametrize("content", [b"", b"no graph"])
def test_a_damaged_graph_is_built_again(faiss: FakeFaiss, tmp_path: Path, content: bytes) -> None:
    gallery_of(clustered(COUNT, WIDTH)).save(tmp_path).prepare(approximate=True)
    graphs(tmp_path)[0].write_bytes(content)
    opened = Gallery.open(tmp_path)
    assert opened.search(opened.embeddings[8], 1, approximate=True)[0].id == "00004"
    assert faiss.built == 2


def test_a_graph_of_other_vectors_is_built_again(faiss: FakeFaiss, tmp_path: Path) -> None:
    gallery_of(clustered(COUNT, WIDTH)).save(tmp_path).prepare(approximate=True)
    with graphs(tmp_path)[0].open("wb") as file:
        np.save(file, np.ones((7, WIDTH), dtype=np.float32))
    Gallery.open(tmp_path).prepare(approximate=True)
    assert faiss.built == 2


def test_where_nothing_can_be_kept_the_graph_stays_in_memory(faiss: FakeFaiss, tmp_path: Path) -> None:
    vectors = clustered(COUNT, WIDTH)
    index = ApproximateIndex(vectors, ExactIndex(vectors), tmp_path / "gone" / "neighbours.faiss")
    assert index.nearest(vectors[3], 1)[0].tolist() == [3]
    index.prepare()
    assert faiss.built == 1


def test_without_the_package_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "faiss", None)
    monkeypatch.setattr(approximate, "WORTHWHILE_FROM", 100)
    gallery = gallery_of(clustered(COUNT, WIDTH))
    with pytest.raises(MissingDependencyError, match=r'pip install "motionrt\[ann\]"'):
        gallery.search(gallery.embeddings[0], approximate=True)
    assert gallery.search(gallery.embeddings[0], 1)[0].id == "00000"


def test_a_query_that_is_not_finite_is_refused(faiss: FakeFaiss) -> None:
    vectors = clustered(COUNT, WIDTH)
    with pytest.raises(InvalidInputError, match="not finite"):
        ApproximateIndex(vectors, ExactIndex(vectors)).nearest(np.full(WIDTH, np.nan, dtype=np.float32), 1)


@pytest.mark.parametrize("width", [64, 256])
def test_faiss_finds_nearly_all_of_the_ten_best(width: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("faiss", reason="faiss-cpu is not installed")
    monkeypatch.setattr(approximate, "WORTHWHILE_FROM", 100)
    saved = gallery_of(clustered(COUNT, width)).save(tmp_path)
    saved.prepare(approximate=True)
    opened, queries = Gallery.open(tmp_path), clustered(50, width, seed=2)
    assert len(graphs(tmp_path)) == 1
    for gallery in (saved, opened):
        found = [{hit.id for hit in gallery.search(query, 10, approximate=True)} for query in queries]
        exact = [{hit.id for hit in gallery.search(query, 10)} for query in queries]
        assert np.mean([len(a & b) / 10 for a, b in zip(found, exact, strict=True)]) > 0.97


def test_a_graph_that_faiss_cannot_read_is_built_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    pytest.importorskip("faiss", reason="faiss-cpu is not installed")
    monkeypatch.setattr(approximate, "WORTHWHILE_FROM", 100)
    saved = gallery_of(clustered(COUNT, 64)).save(tmp_path)
    saved.prepare(approximate=True)
    whole = graphs(tmp_path)[0].read_bytes()
    for content in (b"", b"no graph of faiss", whole[: len(whole) // 2]):
        graphs(tmp_path)[0].write_bytes(content)
        opened = Gallery.open(tmp_path)
        assert opened.search(opened.embeddings[8], 1, approximate=True)[0].id == "00004"
    assert graphs(tmp_path)[0].read_bytes() == whole
