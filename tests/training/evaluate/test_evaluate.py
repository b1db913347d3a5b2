"""Evaluation through the one interface: protocols, moments, the report."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from motions import random_motion, walking

from motionrt.errors import InvalidInputError
from motionrt.metrics import RECALL_AT
from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt_training.corpora import Clip, MotionCorpus
from motionrt_training.corpora.pack import pack, rows_of
from motionrt_training.corpora.reading import read_corpus
from motionrt_training.evaluate.files import FilesRow, later_start
from motionrt_training.evaluate.moments import evaluate_moments
from motionrt_training.evaluate.pairs import PairSet, read_pairs
from motionrt_training.evaluate.protocols import Protocols, by_style, evaluate
from motionrt_training.evaluate.report import MomentLine, Report, Result

WORDS = ("walk", "run", "jump", "sit")


class Oracle:
    """Text i and the motion whose first feature is i stand on axis i; ``wrong`` shifts the texts by one."""

    def __init__(self, wrong: bool = False) -> None:
        self.wrong = wrong

    def embed_text(self, texts: Sequence[str]) -> np.ndarray:
        places = [(WORDS.index(text.split()[0]) + self.wrong) % len(WORDS) for text in texts]
        return np.eye(len(WORDS), dtype=np.float32)[places]

    def embed_motion(self, features: Sequence[np.ndarray]) -> np.ndarray:
        return np.eye(len(WORDS), dtype=np.float32)[[int(x[0, 0]) for x in features]]


def pairs_of(count: int = 4) -> PairSet:
    motions = tuple(np.full((5, 263), i, np.float32) for i in range(count))
    texts = tuple((WORDS[i], f"{WORDS[i]} slowly") for i in range(count))
    return PairSet(tuple(map(str, range(count))), motions, texts)


def unlike(texts: list[str]) -> np.ndarray:
    return np.eye(len(texts), dtype=np.float32)


def test_a_perfect_embedder_is_perfect_under_every_protocol() -> None:
    rows = evaluate(Oracle(), pairs_of(), unlike, Protocols(2))
    assert [row.protocol[:3] for row in rows] == ["(a)", "(b)", "(c)", "(d)"]
    for row in rows:
        assert row.text_to_motion.recall == row.motion_to_text.recall == dict.fromkeys(RECALL_AT, 100.0)


def test_wrong_texts_never_rank_first_and_styles_are_averaged() -> None:
    row = evaluate(Oracle(wrong=True), pairs_of(), unlike, Protocols(2))[0]
    assert (row.pairs, row.text_to_motion.recall[1], row.text_to_motion.queries) == (4, 0.0, 4)


def test_captions_of_a_style_wrap_around_where_a_motion_has_fewer() -> None:
    assert pairs_of(2).captions(1) == ["walk slowly", "run slowly"]
    assert pairs_of(2).captions(2) == ["walk", "run"]


def corpus_of(motion: Motion) -> MotionCorpus:
    clips = (
        Clip("a_0", Path("a.bvh"), 0.0, 3.0, ("walk",), "test", ("walk", "swing")),
        Clip("a_1", Path("a.bvh"), 3.0, 6.0, ("turn left",), "train", ("turn left",)),
        Clip("b_0", Path("b.bvh"), 0.0, None, ("walk",), "val"),
    )
    return MotionCorpus("toy", clips, lambda path: motion)


def test_a_packed_corpus_holds_every_clip_and_reads_back_as_pairs(tmp_path: Path) -> None:
    motion = walking(180, fps=30)
    path = pack(rows_of(corpus_of(motion).motions()), tmp_path / "toy.npz")
    pairs = read_pairs(path, "test")
    expected = guo263.encode(motion.between(0, 3).resample(20))
    np.testing.assert_allclose(pairs.motions[0], expected, atol=2e-3)
    assert (pairs.ids, pairs.texts) == (("a_0",), (("walk",),))
    with np.load(path) as packed:
        meta = json.loads(str(packed["meta"]))
        assert packed["features"].dtype == np.float16
        assert packed["start"].tolist() == [0, 60, 120]
        assert packed["length"].sum() == len(packed["features"])
    assert meta[1]["texts_mirror"] == ["turn right"]
    with pytest.raises(InvalidInputError, match="no clips in split 'dev'"):
        read_pairs(path, "dev")


def test_action_labels_become_one_more_text_to_train_on_only(tmp_path: Path) -> None:
    clips = tuple(
        Clip(split, Path("a.bvh"), 0.0, None, ("walks",), split, ("walk", "wave")) for split in ("train", "test")
    )
    path = pack(rows_of(MotionCorpus("toy", clips, lambda path: walking(30)).motions()), tmp_path / "toy.npz")
    assert read_pairs(path, "train").texts == (("walks", "walk and wave"),)
    assert read_pairs(path, "test").texts == (("walks",),)


def test_corpora_are_found_by_name() -> None:
    with pytest.raises(InvalidInputError, match="no corpus reader 'motionx'"):
        read_corpus("motionx", "folder")
    with pytest.raises(InvalidInputError, match="--amass"):
        read_corpus("babel", "folder")


class Halves:
    """Windows of the straight half of a recording fit "walk", of the turning half "turn"."""

    def embed_text(self, texts: Sequence[str]) -> np.ndarray:
        return np.array([[1, 0] if text.startswith("walk") else [0, 1] for text in texts], np.float32)

    def embed_motion(self, features: Sequence[np.ndarray]) -> np.ndarray:
        turning = np.array([np.mean(np.abs(x[:, guo263.YAW_STEP]) > 0.01) for x in features])
        length = np.array([len(x) for x in features]) / 1000
        return np.stack([1 - turning + length, turning + length], axis=1).astype(np.float32)


def test_moments_of_a_recording_with_two_halves_are_found_and_chance_is_lower() -> None:
    straight, turning = walking(90, fps=30), walking(90, fps=30, turn=1.5)
    joined = Motion(
        np.concatenate([straight.rotations, turning.rotations]), np.concatenate([straight.root, turning.root]), 30
    )
    found = evaluate_moments(Halves(), corpus_of(joined), (20, 60), style=0)
    wrong = evaluate_moments(Halves(), corpus_of(joined), (20, 60), style=0, chance=True)
    assert (found.queries, found.recordings) == (2, 1)
    assert found.accuracy[0.7] == 100.0
    assert wrong.mean_iou < 0.1


@pytest.mark.parametrize("late", [-5, 0, 3])
def test_the_later_start_of_one_of_two_files_of_a_recording_is_found(late: int) -> None:
    motion = random_motion(60, fps=60.0)
    one, other = motion[max(-late, 0) :], motion[max(late, 0) :]
    assert later_start(one, other) == pytest.approx(late / 60)


def test_the_report_names_pairs_baselines_and_moments() -> None:
    rows = evaluate(Oracle(), pairs_of(), unlike, Protocols(1))
    moment = evaluate_moments(Halves(), corpus_of(walking(180, fps=30)), (20,), style=0)
    styles, contrasts = by_style(Oracle(), pairs_of()), {"side": 90.0, "side_captions": 10.0, "path": 75.0}
    results = [Result(name, "4 pairs", rows, styles, contrasts) for name in ("exported", "no filter")]
    files = [("exported", FilesRow(0.99, 0.97, 0.98, 31))]
    page = Report("evaluate it", "toy.npz", results[:1], results[1:], files, [MomentLine("short", moment)]).markdown()
    assert "Written by `evaluate it` from `toy.npz`: whose data it is, is not stated." in page
    assert "| no filter | 4 | 100.0 |" in page
    assert "| exported | 4 pairs | 90.0 | 10 | 75.0 | nan |" in page
    assert "| exported | 31 | 0.9900 | 0.9700 | 0.9800 |" in page
    assert "| short | 2 | 1 |" in page
    assert "HumanML3D, (a) all" in page
