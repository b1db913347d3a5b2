"""The published layouts of the large data sets, on trees that the tests write, and what the reports say of them."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from corpus_trees import SEQUENCES, amass_tree, babel_entry, babel_label, humanml3d_tree, walk, write_json, write_splits

from motionrt.errors import InvalidInputError, MotionFileNotFoundError
from motionrt_training.corpora import reading
from motionrt_training.corpora.amass import amass_file, published_split, read_amass
from motionrt_training.corpora.babel import Label, read_babel
from motionrt_training.corpora.babel_pairs import overlaps, read_babel_pairs
from motionrt_training.corpora.humanml3d import read_humanml3d
from motionrt_training.corpora.kitml import read_kitml

WHOLE = "a person walks#a/DET person/NOUN walk/VERB#0.0#0.0"
FIRST_CUTS = {  # raw_pose_processing.ipynb of HumanML3D, last cell
    "KIT/3/walk": 0.0, "Eyes_Japan_Dataset/hamada/walk": 3.0, "MPI_HDM05/bk/HDM_bk_01": 3.0,
    "TotalCapture/s1/walking1": 1.0, "MPI_Limits/03099/lar1": 1.0, "Transitions_mocap/mazen_c3d/turntwist": 0.5,
}  # fmt: skip

TRAIN = ["000000", "000003", "000004", "000005", "M000000", "000010", "000011"]


@pytest.fixture
def amass(tmp_path: Path) -> Path:
    for name in (*(f"{name}.npz" for name in FIRST_CUTS), "ACCAD/Female1_c3d/A1 - Stand_poses.npz"):
        path = tmp_path / "amass" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return tmp_path / "amass"


def test_humanml3d_is_read_from_its_repository_with_first_cuts_and_a_whole_report(tmp_path: Path, amass: Path) -> None:
    rows = {f"{number:06}": (name, 20, 60) for number, name in enumerate(FIRST_CUTS)}
    rows |= {"M000000": ("KIT/3/walk", 20, 60), "000010": ("KIT/9/absent_poses", 0, 50)}
    rows |= {"000011": ("humanact12/humanact12/P01G01R01F0001T0064A0101", 0, -1), "000012": ("KIT/3/walk", 0, 40)}
    texts = dict.fromkeys(rows, WHOLE)
    folder = humanml3d_tree(tmp_path / "repo", rows, texts, train=TRAIN, val=["000001"], test=["000002"])
    for named in (folder, folder / "HumanML3D"):
        corpus = read_humanml3d(named, amass)
        starts = [(clip.start_s, clip.end_s) for clip in corpus.clips]
        assert starts == [(1.0 + cut, 3.0 + cut) for cut in FIRST_CUTS.values()]
        assert corpus.report is not None
        assert corpus.report.as_dict() == {
            "corpus": "humanml3d", "layout": "repository", "rows": 10, "clips": {"train": 4, "val": 1, "test": 1},
            "missing": ["KIT/9/absent_poses"],
            "skipped": {
                "a mirrored copy; training mirrors by itself": ["M000000"],
                "HumanAct12, whose joints are not there; unpack pose_data/humanact12.zip of the HumanML3D repository":
                ["000011"],
                "in none of train.txt, val.txt, test.txt": ["000012"],
            },
            "notes": {"first 3 s cut off": 2, "first 1 s cut off": 2, "first 0.5 s cut off": 1},
        }  # fmt: skip


def test_swapped_and_equal_times_of_humanml3d_are_read_as_the_unifier_does(tmp_path: Path, amass: Path) -> None:
    lines = ["swapped#x#3.0#1.5", "equal#x#2.0#2.0", "late#x#1.0#9.0", "whole#x#0.0#nan", "half#x#nan#1.0"]
    rows = {"000001": ("TotalCapture/s1/walking1", 20, 100)}
    folder = humanml3d_tree(tmp_path / "repo", rows, {"000001": "\n".join(lines)}, train=["000001"])
    corpus = read_humanml3d(folder, amass)
    spans = [(clip.start_s, clip.end_s, clip.texts) for clip in corpus.clips]
    assert spans == [
        (3.5, 5.0, ("swapped",)), (2.0, 6.0, ("equal", "whole")), (3.0, 6.0, ("late",)), (2.0, 3.0, ("half",)),
    ]  # fmt: skip
    assert corpus.report is not None
    assert corpus.report.notes["captions whose times were swapped"] == 1
    assert corpus.report.notes["captions with equal times, taken for the whole motion"] == 1


def test_humanact12_joints_are_read_where_they_are_unpacked(tmp_path: Path) -> None:
    rows = {"000001": ("humanact12/humanact12/P01A0101", 0, -1)}
    folder = humanml3d_tree(tmp_path / "repo", rows, {"000001": WHOLE}, train=["000001"])
    path = folder / "pose_data/humanact12/humanact12/P01A0101.npy"
    path.parent.mkdir(parents=True)
    joints = walk(0, 2.0).resample(20.0).positions()
    np.save(path, joints)
    corpus = read_humanml3d(folder, tmp_path)
    ((clip, motion),) = corpus.motions()
    assert (clip.start_s, clip.end_s, motion.fps) == (0.0, None, 20.0)
    travelled = joints[-1, 0, [0, 2]] - joints[0, 0, [0, 2]]
    assert np.linalg.norm(motion.root[-1, [0, 2]] - motion.root[0, [0, 2]]) == pytest.approx(
        np.linalg.norm(travelled), rel=0.1
    )


@pytest.mark.parametrize("reader", [read_humanml3d, read_kitml])
def test_annotation_json_with_its_splits_folder_gives_each_stretch_a_clip(reader, tmp_path: Path, amass: Path) -> None:
    parts = [("walks", 0.0, 3.0), ("strolls", 0.0, 3.0), ("turns", 1.0, 2.0), ("empty", 2.0, 2.0)]
    annotations = [{"seg_id": "x", "text": text, "start": start, "end": end} for text, start, end in parts]
    entries = {
        "00001": {"path": "KIT/3/walk", "duration": 3.0, "annotations": annotations},
        "00002": {"path": "KIT/9/absent_poses", "duration": 3.0, "annotations": annotations},
        "00003": {"path": "KIT/3/walk", "duration": 3.0, "annotations": []},
        "00004": {"path": "KIT/3/walk", "duration": 3.0, "annotations": annotations},
    }
    write_json(tmp_path / "tmr/annotations.json", entries)
    write_splits(tmp_path / "tmr/splits", train=["00001", "00002"], val=["00003"])
    corpus = reader(tmp_path / "tmr", amass)
    assert [(clip.id, clip.start_s, clip.end_s, clip.texts) for clip in corpus.clips] == [
        ("00001", 0.0, 3.0, ("walks", "strolls")), ("00001_1", 1.0, 2.0, ("turns",)),
    ]  # fmt: skip
    assert corpus.report is not None
    assert corpus.report.missing == ["KIT/9/absent_poses"]
    assert {name for names in corpus.report.skipped.values() for name in names} == {"00003", "00004"}


def test_sequences_are_found_in_both_copies_of_amass_and_with_the_data_set_twice(tmp_path: Path) -> None:
    copies = {  # how annotations name it -> how a copy has it
        "BioMotionLab_NTroje/rub001/0000_treadmill_norm_poses": "BMLrub/rub001/0000_treadmill_norm_stageii",
        "./pose_data/ACCAD/Female1_c3d/A1 - Stand_poses.npy": "ACCAD/Female1_c3d/A1_-_Stand_stageii",
        "Eyes_Japan_Dataset/hamada/walk 01 hamada_poses": "EyesJapanDataset/hamada/walk-01-hamada_stageii",
        "MPI_Limits/03099/lar1_poses.npz": "PosePrior/03099/lar1_stageii",
        "KIT/KIT/3/kick_poses.npz": "KIT/3/kick_poses",
        "CMU/01/01_01_poses": "CMU/CMU/01/01_01_poses",
        "SSM_synced/20160330/1.5_jump_poses": "SSM/20160330/1.5_jump_stageii",
    }
    for number, place in enumerate(copies.values()):
        path = tmp_path / str(number) / f"{place}.npz"
        path.parent.mkdir(parents=True)
        path.touch()
    found = [amass_file(tmp_path / str(number), name) for number, name in enumerate(copies)]
    assert found == [tmp_path / str(number) / f"{place}.npz" for number, place in enumerate(copies.values())]
    assert amass_file(tmp_path / "0", "KIT/3/kick_poses") is None


def test_amass_alone_has_its_recommended_splits_and_leaves_body_shapes_out(tmp_path: Path) -> None:
    names = ["KIT/3/walk_poses", "HDM05/bk/a_stageii", "SSM_synced/x/b_poses", "KIT/3/shape", "HDM05/bk/n_stagei"]
    for name in names:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / f"{name}.npz").touch()
    corpus = read_amass(tmp_path)
    assert {clip.id: clip.split for clip in corpus.clips} == {
        "HDM05/bk/a_stageii": "val", "KIT/3/walk_poses": "train", "SSM_synced/x/b_poses": "test",
    }  # fmt: skip
    assert corpus.report is not None
    assert corpus.report.skipped == {"a body shape, not a motion": ["HDM05/bk/n_stagei.npz", "KIT/3/shape.npz"]}
    assert published_split("Transitions/a/b") == "test"


def babel_tree(folder: Path) -> Path:
    def walks(*labels: dict[str, object]) -> dict[str, object]:
        return babel_entry("KIT/3/walk", *labels, seconds=10.0)

    write_json(folder / "train.json", {
        "1": walks(babel_label("walk", 0, 6), babel_label("wave", 2, 4, raw_label="waves his hand")),
        "2": walks(babel_label("walk", 0, 3), babel_label("nod", 2.9, 6), babel_label("transition", 0, 5)),
        "3": walks(babel_label("throw")),
        "4": walks(),
    })  # fmt: skip
    write_json(folder / "val.json", {
        "5": walks(babel_label("walk", 0, 5), babel_label("wave", 1, 3)),
        "6": walks(babel_label("stand", 0, 5), babel_label("drink", 1, 3)),
        "7": walks(babel_label("walk", 0, 5), babel_label("drink", 1, 3), babel_label("nod", 2, 12)),
    })  # fmt: skip
    several = {"labels": [babel_label("hop", 0, 1)]}, {"labels": [babel_label("jump", 0, 2)]}
    entry = {"feat_p": "KIT/KIT/3/walk.npz", "dur": 4.0, "frame_anns": list(several), "seq_anns": []}
    write_json(folder / "extra_train.json", {"8": entry})
    return folder


def test_babel_has_raw_and_processed_labels_categories_and_the_extra_files(tmp_path: Path, amass: Path) -> None:
    folder = babel_tree(tmp_path / "babel")
    raw, processed = (read_babel(folder, amass, spelling=spelling) for spelling in ("raw", "proc"))
    texts = {clip.id: clip.texts[0] for clip in raw.clips}
    assert (texts["1_1"], texts["8_0"], texts["8_1"]) == ("waves his hand", "hop", "jump")
    assert {clip.id: clip.texts[0] for clip in processed.clips}["1_1"] == "wave"
    by_id = {clip.id: clip for clip in raw.clips}
    assert (by_id["8_0"].split, by_id["8_0"].categories) == ("train", ("hop",))
    assert (by_id["3_0"].start_s, by_id["3_0"].end_s) == (0.0, 10.0)
    assert by_id["7_2"].end_s == 10.0  # a label does not outlast its sequence
    assert raw.report is not None
    assert raw.report.skipped == {"has no caption": ["4"]}
    assert raw.report.notes == {"transitions and calibration poses left out": 1}
    with pytest.raises(InvalidInputError, match="raw and proc"):
        read_babel(folder, amass, spelling="typed")


def test_overlaps_are_the_stretches_in_which_exactly_two_actions_hold() -> None:
    labels = [Label("walk", 0, 5), Label("drink", 1, 3), Label("nod", 2, 10)]
    assert overlaps(labels) == [(1, 2, ("walk", "drink")), (3, 5, ("walk", "nod"))]
    assert overlaps([Label("walk", 0, 3), Label("walk", 1, 2), Label("run", 3, 4)]) == []


def test_babel_pairs_are_those_of_sinc(tmp_path: Path, amass: Path) -> None:
    corpus = read_babel_pairs(babel_tree(tmp_path / "babel"), amass)
    pairs = {clip.id: (clip.labels, clip.split, clip.start_s, clip.end_s) for clip in corpus.clips if "pair" in clip.id}
    assert pairs == {
        "1_pair_0": (("walk", "wave"), "train", 2.0, 4.0),
        "8_pair_0": (("hop", "jump"), "train", 0.0, 1.0),
        "7_pair_0": (("walk", "drink"), "test", 1.0, 2.0),
        "7_pair_1": (("walk", "nod"), "test", 3.0, 5.0),
    }
    assert corpus.report is not None
    assert corpus.report.skipped["a pair of the test set with 'stand'"] == ["6_pair_0"]
    assert corpus.report.skipped["a pair of the test set that training has, too"] == ["5_pair_0"]
    assert corpus.report.skipped["shorter than 0.5 s or longer than 20 s"] == ["2_pair_0"]
    assert {clip.split for clip in corpus.clips if "pair" not in clip.id} == {"train", "val"}
    everything = read_babel_pairs(tmp_path / "babel", amass, every=True)
    assert {clip.id for clip in everything.clips} - {clip.id for clip in corpus.clips} == {"5_pair_0", "6_pair_0"}


def test_wrong_folders_give_one_clear_error(tmp_path: Path, amass: Path) -> None:
    folder = humanml3d_tree(tmp_path / "repo", {"1": ("KIT/3/walk", 0, 20)}, {"1": WHOLE}, train=["1"])
    with pytest.raises(
        MotionFileNotFoundError, match=r"none of the 1 sequences of humanml3d lie in .*which has no KIT"
    ):
        read_humanml3d(folder, tmp_path)
    with pytest.raises(MotionFileNotFoundError, match="is no folder; name the AMASS folder"):
        read_humanml3d(folder, tmp_path / "nowhere")
    with pytest.raises(MotionFileNotFoundError, match="is not HumanML3D"):
        read_humanml3d(tmp_path / "amass", amass)
    (tmp_path / "zip").mkdir()
    (tmp_path / "zip/index.csv").touch()
    (tmp_path / "zip/texts.zip").touch()
    with pytest.raises(MotionFileNotFoundError, match=r"unpack .*texts\.zip"):
        read_humanml3d(tmp_path / "zip", amass)
    with pytest.raises(MotionFileNotFoundError, match="is not BABEL"):
        read_babel(folder, amass)


def test_the_command_prints_the_report_or_one_line(tmp_path: Path, amass: Path, capsys, monkeypatch) -> None:
    folder = babel_tree(tmp_path / "babel")
    monkeypatch.setattr(sys, "argv", ["reading", "babel_pairs", str(folder), "--amass", str(amass)])
    reading.main()
    assert capsys.readouterr().out.splitlines()[0] == (
        "babel_pairs (train.json extra_train.json val.json): 8 annotated motions, 18 clips: train 9, val 7, test 2"
    )
    monkeypatch.setattr(sys, "argv", ["reading", "babel", str(tmp_path / "no"), "--amass", str(amass)])
    with pytest.raises(SystemExit, match=r"^error: .*no is no folder; name the folder of babel$"):
        reading.main()


def test_motions_that_cannot_be_read_are_left_out_and_reported(tmp_path: Path) -> None:
    amass = amass_tree(tmp_path / "amass", SEQUENCES[:2], seconds=2.0)
    (amass / f"{SEQUENCES[1]}.npz").write_bytes(b"PK broken")
    rows = {str(number): (name, 0, 20) for number, name in enumerate(SEQUENCES[:2])} | {"2": (SEQUENCES[0], 90, 120)}
    folder = humanml3d_tree(tmp_path / "repo", rows, dict.fromkeys(rows, WHOLE), train=list(rows))
    corpus = read_humanml3d(folder, amass)
    assert [clip.id for clip, _ in corpus.motions()] == ["0"]
    assert corpus.report is not None
    reasons = {reason.split(" (")[0]: names for reason, names in corpus.report.skipped.items()}
    assert reasons["begins behind the end of its recording"] == ["2"]
    assert reasons["cannot be read"] == [str(amass / f"{SEQUENCES[1]}.npz")]
