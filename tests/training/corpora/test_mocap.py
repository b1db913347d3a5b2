"""The reader of several deliveries of captioned recordings."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats import save_motion
from motionrt.motion import Motion
from motionrt.motion.skeleton import SMPL24
from motionrt_training.corpora.mocap import provenance, read_mocap

ROW = {"start_s": 0.0, "end_s": 1.0, "labels": [{"text": "walk", "parts": ["left leg", "right leg"]}]}


def _write(folder: Path, index: list[dict[str, str]], captions: list[dict[str, object]]) -> None:
    folder.mkdir(parents=True)
    with (folder / "index.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(index[0]))
        writer.writeheader()
        writer.writerows(index)
    (folder / "captions.jsonl").write_text("\n".join(map(json.dumps, captions)), encoding="utf-8")


def _bvh(path: Path, fps: float) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    rotations = np.tile(np.eye(3, dtype=np.float32), (60, 24, 1, 1))
    root = np.stack([np.zeros(60), np.full(60, 1.4), np.linspace(0, 2, 60)], axis=1).astype(np.float32)
    save_motion(Motion(rotations, root, fps, SMPL24), path)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two deliveries: one recording of two segments beside its captions, one of an archive, one without captions."""
    first = {"trial": "07_01", "format": "bvh", "frames": "60", "fps": "30", "source_repo": "someone/cmu"}
    captions = [
        {**ROW, "id": "07_01_001", "trial": "07_01", "split": "val", "start_s": 1.0, "end_s": 2.0, "captions": ["b"]},
        {**ROW, "id": "07_01_000", "trial": "07_01", "split": "val", "captions": ["a"]},
    ]
    _write(tmp_path / "cmu", [first], captions)
    (tmp_path / "cmu" / "paraphrases.jsonl").write_text(
        json.dumps({"id": "07_01_000", "short": "stroll", "more": ["go for a stroll"]}), encoding="utf-8"
    )
    _bvh(tmp_path / "cmu" / "bvh" / "07_01.bvh", 30)
    shared = {"archive": "lab.tar.xz", "animation": "", "asf": "", "format": "bvh", "frames": "60", "licence": "MIT"}
    more = [
        {**shared, "trial": "x/1", "file": "x/1.bvh", "fps": "24", "source": "lab/repo"},
        {**shared, "trial": "x/2", "file": "x/2.bvh", "fps": "24", "source": "lab/repo"},
    ]
    _write(tmp_path / "more", more, [{**ROW, "id": "x1", "trial": "x/1", "split": "test", "captions": ["c"]}])
    for name in ("1", "2"):
        _bvh(tmp_path / "unpacked" / "lab" / "x" / f"{name}.bvh", 30)
    return tmp_path


def test_segments_come_in_order_of_time_with_all_their_sentences(folder: Path) -> None:
    (recording,) = read_mocap(folder)
    assert [segment.id for segment in recording.segments] == ["07_01_000", "07_01_001"]
    assert recording.segments[0].captions == ("a", "stroll", "go for a stroll")
    assert recording.segments[0].labels == (("walk", frozenset({"left leg", "right leg"})),)
    assert recording.split == "val"


def test_the_index_says_the_frame_rate(folder: Path) -> None:
    recordings = {recording.id: recording for recording in read_mocap(folder, folder / "unpacked")}
    assert recordings["x/1"].load().fps == 24  # the file itself says 30
    assert recordings["07_01"].load().positions()[..., 1].min() < 0.05  # grounded: it was saved half a metre higher


def test_recordings_without_captions_are_there_to_train_on(folder: Path) -> None:
    recordings = {recording.id: recording for recording in read_mocap(folder, folder / "unpacked")}
    assert recordings["x/2"].segments == ()
    assert recordings["x/2"].split == "train"
    assert recordings["x/1"].split == "test"


def test_sources_can_be_left_out_and_are_listed_with_their_licences(folder: Path) -> None:
    everything = read_mocap(folder, folder / "unpacked")
    assert [row["source"] for row in provenance(everything)] == ["cmu", "lab"]
    assert provenance(everything)[1] == {"source": "lab", "licence": "MIT", "origin": "lab/repo", "recordings": 2}
    assert {one.source for one in read_mocap(folder, folder / "unpacked", sources=["cmu"])} == {"cmu"}
    with pytest.raises(InvalidInputError, match="there are: cmu, lab"):
        read_mocap(folder, folder / "unpacked", sources=["amass"])


def test_what_is_missing_is_named(folder: Path) -> None:
    (folder / "unpacked" / "lab" / "x" / "1.bvh").unlink()
    with pytest.raises(MotionFileNotFoundError, match=r"1\.bvh"):
        read_mocap(folder, folder / "unpacked")
    with pytest.raises(MotionFileNotFoundError, match=r"index\.csv"):
        read_mocap(folder / "unpacked")
    (folder / "cmu" / "captions.jsonl").write_text('{"id": "y"}\n', encoding="utf-8")
    with pytest.raises(FormatError, match=r"line 1|:1"):
        read_mocap(folder)
