"""Action recognition by text, the share of dropped negatives, and the papers' figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from motions import walking

from motionrt.errors import InvalidInputError
from motionrt_training.corpora import Clip, MotionCorpus
from motionrt_training.evaluate.actions import frequent_classes, recognise, recognition_table
from motionrt_training.evaluate.filtering import drawn_pairs, filtering_table, published_share
from motionrt_training.evaluate.published import figures, papers, retrieval_figures

NAMES = ("walk", "wave", "nod")


class ByLength:
    """A motion of 20 k frames at 20 fps is the k-th name."""

    def embed_text(self, texts):
        return np.eye(3, dtype=np.float32)[[NAMES.index(text.removeprefix("somebody: ")) for text in texts]]

    def embed_motion(self, features):
        return np.eye(3, dtype=np.float32)[[round(len(x) / 20) - 1 for x in features]]


def corpus_of(*rows: tuple[str, float, tuple[str, ...], tuple[str, ...]]) -> MotionCorpus:
    clips = tuple(
        Clip(str(number), Path("a.bvh"), 0.0, end, ("x",), split, labels, categories=categories)
        for number, (split, end, categories, labels) in enumerate(rows)
    )
    return MotionCorpus("toy", clips, lambda _: walking(120, fps=30))


def test_motions_are_named_by_the_nearest_class_and_any_of_theirs_is_right() -> None:
    corpus = corpus_of(
        ("train", 1, ("walk",), ()), ("train", 1, ("walk", "wave"), ()), ("train", 1, (), ("nod",)),
        ("val", 1, ("walk",), ()), ("val", 1, ("walk",), ()), ("val", 1, ("wave", "walk"), ()),
        ("val", 2, ("nod",), ()), ("val", 3, ("unknown",), ()), ("val", 0.2, ("walk",), ()),
    )  # fmt: skip
    classes = frequent_classes(corpus, 3)
    assert classes == ["walk", "nod", "wave"]
    row = recognise(ByLength(), corpus.split("val"), classes, "somebody: {}")
    assert (row.clips, row.classes, row.top1, row.top5) == (4, 3, 75.0, 100.0)
    assert row.per_class == pytest.approx(100 * (1 + 0 + 1) / 3)  # walk, nod, wave
    assert row.most_common == 75.0
    assert "| toy | 4 | 3 | 75.0 | 100.0 | 66.7 | 75.0 |" in recognition_table([("toy", row)])
    with pytest.raises(InvalidInputError, match="no clip of toy has any of the 1 classes"):
        recognise(ByLength(), corpus.split("val"), ["fly"])
    with pytest.raises(InvalidInputError, match="neither action categories nor labels"):
        frequent_classes(corpus.split("test"), 3)


def test_the_share_of_dropped_pairs_follows_the_threshold_and_is_met_by_its_inverse() -> None:
    captions = [[f"text {number}"] for number in range(20)] + [["turn left"], ["turn right"]]

    def embed(texts: list[str]) -> np.ndarray:
        rows = np.random.default_rng(3).normal(size=(len(texts), 4))
        rows[[texts.index("turn left"), texts.index("turn right")]] = 1.0
        return rows / np.linalg.norm(rows, axis=1, keepdims=True)

    pairs = drawn_pairs(captions, embed, batch=22, batches=3)
    shares = [pairs.share(threshold, respect_directions=False) for threshold in (0.0, 0.5, 0.9, 0.999)]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] == 100.0
    assert shares[-1] == pytest.approx(100 * 2 / (22 * 21))  # left and right, which are no duplicates
    assert pairs.share(0.999, respect_directions=True) == 0.0
    for rule in (True, False):
        threshold = pairs.threshold_of(published_share(), respect_directions=rule)
        assert pairs.share(threshold, respect_directions=rule) == pytest.approx(published_share(), abs=0.3)
    assert "| 0.8 |" in filtering_table(pairs, 17.29)


def test_every_figure_names_a_known_paper_and_its_place() -> None:
    assert {figure.paper for figure in figures()} == {*papers()} == {"TMR", "SINC", "Continual"}
    assert all(figure.place and figure.what for figure in figures())
    for row in retrieval_figures():
        for values in (row.t2m, row.m2t):
            assert len(values) == 6
            assert list(values[:5]) == sorted(values[:5])
    (kit,) = [row for row in retrieval_figures() if row.row == "KIT-ML, (d) batches of 32"]
    assert kit.t2m[2] == 78.25
