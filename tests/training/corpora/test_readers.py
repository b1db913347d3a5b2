"""Corpus readers on small annotation files that the tests write."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt_training.corpora import Clip
from motionrt_training.corpora.babel import read_babel
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.humanml3d import read_humanml3d
from motionrt_training.corpora.kitml import read_kitml


def write(path: Path, content: object) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


def splits(folder: Path, **keys: str) -> None:
    for split in ("train", "val", "test"):
        write(folder / f"{split}.txt", keys.get(split, ""))


@pytest.fixture
def amass(tmp_path: Path) -> Path:
    for name in ("KIT/3/kick_poses.npz", "CMU/01/01_01_poses.npz", "ACCAD/walk_stageii.npz"):
        write(tmp_path / "amass" / name, "")
    return tmp_path / "amass"


def cmu_row(**changes: object) -> dict[str, object]:
    row = {"id": "01_01_000", "trial": "01_01", "start_s": 0.5, "end_s": 3.0, "split": "val",
           "labels": [{"text": "jump", "parts": ["global"]}], "captions": ["a jump", "he jumps"]}  # fmt: skip
    return row | changes


def test_cmu_captions_name_a_bvh_or_an_amc_trial(tmp_path: Path) -> None:
    write(tmp_path / "bvh" / "01_01.bvh", "")
    write(tmp_path / "amc" / "02_01.amc", "")
    rows = [cmu_row(), cmu_row(id="02_01_000", trial="02_01", split="test")]
    write(tmp_path / "captions.jsonl", "\n".join(map(json.dumps, rows)) + "\n\n")
    corpus = read_cmu(tmp_path)
    first = Clip("01_01_000", tmp_path / "bvh/01_01.bvh", 0.5, 3.0, ("a jump", "he jumps"), "val", ("jump",))
    assert corpus.clips[0] == first
    assert [clip.path.suffix for clip in corpus.split("test").clips] == [".amc"]


def test_cmu_errors_name_file_and_line(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"captions\.jsonl"):
        read_cmu(tmp_path)
    write(tmp_path / "captions.jsonl", json.dumps(cmu_row()))
    with pytest.raises(MotionFileNotFoundError, match="trial 01_01"):
        read_cmu(tmp_path)
    write(tmp_path / "bvh" / "01_01.bvh", "")
    write(tmp_path / "captions.jsonl", json.dumps(cmu_row()) + "\n{broken")
    with pytest.raises(FormatError, match=r"captions\.jsonl:2: not JSON"):
        read_cmu(tmp_path)
    write(tmp_path / "captions.jsonl", json.dumps({"id": "x"}))
    with pytest.raises(FormatError, match=r"captions\.jsonl:1: .*labels"):
        read_cmu(tmp_path)


@pytest.mark.parametrize(
    ("changes", "message"),
    [({"split": "dev"}, "split 'dev'"), ({"texts": ()}, "at least one text"), ({"end_s": 0.0}, "before it starts")],
)
def test_impossible_clips_are_refused(changes: dict[str, object], message: str) -> None:
    fine = {"id": "a", "path": Path("a.bvh"), "start_s": 0.0, "end_s": 1.0, "texts": ("x",), "split": "val"}
    with pytest.raises(InvalidInputError, match=message):
        Clip(**(fine | changes))  # type: ignore[arg-type]


def test_humanml3d_skips_mirrored_and_absent_motions_and_splits_partial_captions(tmp_path: Path, amass: Path) -> None:
    folder = tmp_path / "h3d"
    splits(folder, train="000001\nM000001\n000002", test="000003")
    index = [
        "source_path,start_frame,end_frame,new_name",
        "./pose_data/KIT/3/kick_poses.npy,20,100,000001.npy",
        "./pose_data/KIT/9/absent_poses.npy,0,50,000002.npy",
        "./pose_data/ACCAD/walk_poses.npy,0,-1,000003.npy",
    ]
    write(folder / "index.csv", "\n".join(index))
    write(folder / "texts/000001.txt", "a kick#a/DET kick/NOUN#0.0#0.0\nkicks late#x#1.5#3.0\nagain#x#0.0#nan\n")
    write(folder / "texts/000003.txt", "walks#x#0.0#0.0")
    clips = read_humanml3d(folder, amass).clips
    spans = [(clip.id, clip.start_s, clip.end_s, clip.texts, clip.split) for clip in clips]
    assert spans == [
        ("000001", 1.0, 5.0, ("a kick", "again"), "train"),
        ("000001_1", 2.5, 4.0, ("kicks late",), "train"),
        ("000003", 0.0, None, ("walks",), "test"),
    ]
    write(folder / "texts/000003.txt", "fine#x#0#0\nno hashes")
    with pytest.raises(FormatError, match=r"000003\.txt:2"):
        read_humanml3d(folder, amass)


def test_kitml_reads_its_own_and_the_unified_layout_alike(tmp_path: Path, amass: Path) -> None:
    own, unified = tmp_path / "own", tmp_path / "unified"
    for folder in (own, unified):
        splits(folder, train="00001 00002", val="00003")
    write(own / "amass_paths.json", {"00001": "KIT/3/kick_poses", "00002": "KIT/none", "00003": "CMU/01/01_01_poses"})
    for key, texts in (("00001", ["kick", "a kick"]), ("00002", ["x"]), ("00003", [])):
        write(own / f"{key}_annotations.json", texts)
    parts = [{"text": "kick", "start": 0.0, "end": 2.0}, {"text": "a kick", "start": 0.0, "end": 2.0}]
    write(unified / "annotations.json", {"00001": {"path": "KIT/3/kick_poses", "annotations": parts}})
    for folder in (own, unified):
        clips = read_kitml(folder, amass).clips
        assert [(clip.id, clip.texts, clip.split) for clip in clips] == [("00001", ("kick", "a kick"), "train")]
        assert clips[0].path == amass / "KIT/3/kick_poses.npz"
    write(unified / "annotations.json", {"00001": {"annotations": []}})
    with pytest.raises(FormatError, match=r"00001.*path"):
        read_kitml(unified, amass)


def test_babel_frame_labels_become_clips_with_their_simultaneous_labels(tmp_path: Path, amass: Path) -> None:
    frames = [
        {"raw_label": "walk", "start_t": 0, "end_t": 4},
        {"raw_label": "wave", "start_t": 1, "end_t": 3},
        {"raw_label": "transition", "start_t": 4, "end_t": 5},
    ]
    entries = {
        "7": {"feat_p": "CMU/CMU/01/01_01_poses.npz", "dur": 5.0, "frame_ann": {"labels": frames}, "seq_ann": None},
        "8": {"feat_p": "ACCAD/ACCAD/walk_poses.npz", "dur": 2.0, "seq_ann": {"labels": [{"raw_label": "stand"}]}},
        "9": {"feat_p": "KIT/KIT/none.npz", "dur": 2.0, "seq_ann": {"labels": [{"raw_label": "lost"}]}},
    }
    write(tmp_path / "babel/val.json", entries)
    clips = read_babel(tmp_path / "babel", amass).clips
    assert [(clip.id, clip.start_s, clip.end_s, clip.labels) for clip in clips] == [
        ("7_0", 0.0, 4.0, ("walk",)),
        ("7_1", 1.0, 3.0, ("wave", "walk")),
        ("8_0", 0.0, 2.0, ("stand",)),
    ]
    assert {clip.split for clip in clips} == {"val"}
    write(tmp_path / "babel/val.json", {"7": {"dur": 1}})
    with pytest.raises(FormatError, match=r"'7'.*feat_p"):
        read_babel(tmp_path / "babel", amass)


def test_missing_annotation_folders_say_what_they_lack(tmp_path: Path, amass: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"train\.json"):
        read_babel(tmp_path, amass)
    for reader in (read_humanml3d, read_kitml):
        with pytest.raises(MotionFileNotFoundError, match=r"train\.txt"):
            reader(tmp_path, amass)
