"""Which skeleton and which frame rate an AMC file gets."""

from __future__ import annotations

from pathlib import Path

import pytest
from mini_files import AMC, ASF, write

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt.formats import read_amc
from motionrt.formats.acclaim.asf_search import find_asf, find_fps
from motionrt.untrusted.files import confined


def skeleton(path: Path, thigh: float) -> Path:
    return write(path, ASF.replace("length 8", f"length {thigh}"))


def test_own_trial_then_subject_then_default(tmp_path: Path) -> None:
    amc = write(tmp_path / "amc" / "16_03.amc", AMC)
    for name in ("02.asf", "default.asf", "16.asf", "16_03.asf"):
        found = skeleton(tmp_path / "asf" / name, 8)
        assert find_asf(amc).path == found


def test_beside_the_file_wins_over_the_asf_folder(tmp_path: Path) -> None:
    amc = write(tmp_path / "amc" / "16_03.amc", AMC)
    skeleton(tmp_path / "asf" / "16.asf", 8)
    beside = skeleton(tmp_path / "amc" / "16.ASF", 8)
    assert find_asf(amc).path == beside


def test_an_explicit_skeleton_wins(tmp_path: Path) -> None:
    amc = write(tmp_path / "16_03.amc", AMC)
    skeleton(tmp_path / "16.asf", 8)
    assert read_amc(amc, skeleton(tmp_path / "mine.asf", 20)).offsets[3, 1] == -20


def test_stand_in_is_the_skeleton_with_legs_of_median_length(tmp_path: Path) -> None:
    amc = write(tmp_path / "88_01.amc", AMC)
    for name, thigh in (("01", 9.0), ("02", 5.0), ("03", 8.0), ("04", 7.0)):
        skeleton(tmp_path / f"{name}.asf", thigh)
    assert find_asf(amc).path.name == "04.asf"
    skeleton(tmp_path / "05.asf", 30.0)
    assert find_asf(amc).path.name == "03.asf"


def test_equal_stand_ins_are_taken_by_name_and_unreadable_ones_are_passed_over(tmp_path: Path) -> None:
    amc = write(tmp_path / "88_01.amc", AMC)
    for name in ("b", "a", "c"):
        skeleton(tmp_path / f"{name}.asf", 8)
    write(tmp_path / "d.asf", "garbage")
    assert find_asf(amc).path.name == "b.asf"


def test_a_broken_skeleton_of_the_subject_is_an_error_and_not_replaced(tmp_path: Path) -> None:
    amc = write(tmp_path / "88_01.amc", AMC)
    skeleton(tmp_path / "01.asf", 8)
    write(tmp_path / "88.asf", "garbage")
    with pytest.raises(FormatError, match=r"88\.asf"):
        find_asf(amc)


def test_no_skeleton_at_all_says_where_it_was_looked_for(tmp_path: Path) -> None:
    amc = write(tmp_path / "amc" / "88_01.amc", AMC)
    with pytest.raises(MotionFileNotFoundError, match=r"no \.asf skeleton .*give one with asf="):
        find_asf(amc)


@pytest.mark.parametrize("index_folder", ["amc", "."])
def test_rate_comes_from_the_index_beside_or_above(tmp_path: Path, index_folder: str) -> None:
    amc = write(tmp_path / "amc" / "16_03.amc", AMC)
    assert find_fps(amc) == 120
    write(tmp_path / index_folder / "index.csv", "trial,format,frames,fps\n16_02,amc,2,30\n16_03,amc,2,60\n")
    assert find_fps(amc) == 60


@pytest.mark.parametrize("index", ["name;rate\n16_03;60\n", "trial,fps\n16_04,60\n", "trial,fps\n16_03,\n", "\xff\0"])
def test_an_index_that_does_not_know_the_trial_is_ignored(tmp_path: Path, index: str) -> None:
    amc = write(tmp_path / "16_03.amc", AMC)
    write(tmp_path / "index.csv", index.encode("latin-1"))
    assert find_fps(amc) == 120


@pytest.mark.parametrize("fps", ["fast", "0", "nan", "-60"])
def test_an_index_with_a_nonsensical_rate_is_an_error(tmp_path: Path, fps: str) -> None:
    amc = write(tmp_path / "16_03.amc", AMC)
    write(tmp_path / "index.csv", f"trial,fps\n16_03,{fps}\n")
    with pytest.raises(FormatError, match=r"index\.csv: trial '16_03' has fps"):
        find_fps(amc)


def test_fps_given_wins(tmp_path: Path) -> None:
    amc = write(tmp_path / "16_03.amc", AMC)
    skeleton(tmp_path / "16.asf", 8)
    assert read_amc(amc).fps == 120
    assert read_amc(amc, fps=60).fps == 60


def test_where_only_uploaded_files_may_be_read_nothing_outside_their_folder_is_looked_for(tmp_path: Path) -> None:
    uploads, outside = tmp_path / "uploads", tmp_path / "asf"
    for folder in (uploads, outside):
        folder.mkdir()
    skeleton(outside / "01.asf", 1.0)
    (tmp_path / "index.csv").write_text("trial,fps\n01_01,nonsense\n", encoding="utf-8")
    trial = write(uploads / "01_01.amc", AMC)
    assert find_asf(trial).path == outside / "01.asf"
    with confined(uploads):
        with pytest.raises(MotionFileNotFoundError):
            find_asf(trial)
        assert find_fps(trial) == 120
        assert (
            find_asf(trial.with_name(skeleton(uploads / "01.asf", 1.0).with_suffix(".amc").name)).path.parent == uploads
        )
