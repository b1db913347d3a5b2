"""Whose data it is travels from the pack to the page of figures; pages are not written over."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from motions import walking

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.motion import Motion
from motionrt_training.corpora import Clip, MotionCorpus
from motionrt_training.corpora.positions import unpack_positions
from motionrt_training.corpora.prepare import parts_by_rules, parts_from, prepare
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.data_record import data_of, data_record
from motionrt_training.evaluate.__main__ import describe, free_page
from motionrt_training.packed import load_packed

MINE = data_record("toy", 0, "mine alone")


def corpus(motion: Motion) -> MotionCorpus:
    clips = (
        Clip("0", Path("/data/toy/a/1.npz"), 0.0, 2.0, ("walks",), "train", ("walk", "wave the right hand")),
        Clip("1", Path("/data/toy/a/1.npz"), 2.0, None, ("walks on",), "val", ("walk",)),
        Clip("2", Path("/data/toy/a/2.npz"), 0.5, 99.0, ("strolls",), "train"),
    )
    return MotionCorpus("toy", clips, lambda _: motion)


def test_one_reading_makes_every_pack_and_each_says_whose_data_it_is(tmp_path: Path) -> None:
    motion = walking(120, fps=30)
    folder = prepare(corpus(motion), tmp_path / "mine", parts_by_rules(), MINE)
    said = [{"source": "toy", "licence": "mine alone", "origin": "not stated", "recordings": 2}]
    assert all(data_of(folder / name) == said for name in ("pairs.npz", "recordings.npz", "positions.npz"))
    recordings = load_recordings(folder / "recordings.npz")
    assert recordings.ids == ("toy/a/1", "toy/a/2")
    assert recordings.splits == ("val", "train")  # a recording with a clip of another split is held out whole
    np.testing.assert_allclose(recordings.named("toy/a/2").root, motion.root, atol=1e-5)
    packed = {clip.id: clip for clip in load_packed(folder / "pairs.npz").clips}
    assert {name: (clip.split, clip.length) for name, clip in packed.items()} == {
        "0": ("train", 40), "1": ("val", 40), "2": ("train", 70),
    }  # fmt: skip
    rows = [json.loads(line) for line in (folder / "captions.jsonl").read_text(encoding="utf-8").splitlines()]
    assert [(row["trial"], row["start_s"], row["end_s"], row["split"]) for row in rows] == [
        ("toy/a/1", 0.0, 2.0, "train"), ("toy/a/1", 2.0, motion.duration, "val"),
        ("toy/a/2", 0.5, motion.duration, "train"),
    ]  # fmt: skip
    assert rows[0]["labels"][1] == {"text": "wave the right hand", "parts": ["right arm"]}
    spans = {
        one.id: [(span.first, span.count) for span in one.spans] for one in unpack_positions(folder / "positions.npz")
    }
    assert spans == {"toy/a/1": [(40, 40)], "toy/a/2": [(10, 70)]}


def test_parts_come_from_a_file_and_for_other_labels_from_the_rules(tmp_path: Path) -> None:
    file = tmp_path / "parts.jsonl"
    file.write_text('{"text": "walk", "parts": ["torso"]}\n{"text": "zorble", "parts": []}\n', encoding="utf-8")
    parts = parts_from(file)
    assert parts("walk") == {"torso"}
    assert parts("zorble") == frozenset()
    assert parts("nod") == {"torso"}
    file.write_text('{"text": "walk"}\n', encoding="utf-8")
    with pytest.raises(FormatError, match=r"parts\.jsonl:1: .*parts"):
        parts_from(file)
    with pytest.raises(MotionFileNotFoundError, match="motionrt parts --file"):
        parts_from(tmp_path / "none.jsonl")


def test_a_pack_without_a_record_states_nothing(tmp_path: Path) -> None:
    np.savez(tmp_path / "old.npz", features=np.zeros(1))
    assert data_of(tmp_path / "old.npz") == data_of(tmp_path / "absent.npz") == []
    assert describe([]) == "whose data it is, is not stated"
    assert describe(MINE) == "toy (0 recordings, licence mine alone)"


def test_a_page_that_is_there_is_written_over_only_when_that_is_said(tmp_path: Path) -> None:
    page = tmp_path / "search.md"
    assert free_page(page, overwrite=False) == page
    page.touch()
    with pytest.raises(InvalidInputError, match="--overwrite"):
        free_page(page, overwrite=False)
    assert free_page(page, overwrite=True) == page
