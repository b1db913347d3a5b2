"""A study of motions: pairs by name, a page without a network or names, votes and their interval."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from motions import random_motion, walking
from scipy.stats import binomtest

from motionrt.cli import main
from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.study import count_votes, find_pairs, wilson, write_study
from motionrt.study.votes import write_votes


@pytest.fixture
def folders(tmp_path: Path) -> tuple[Path, Path]:
    made = tmp_path / "ours", tmp_path / "theirs"
    for number, folder in enumerate(made):
        folder.mkdir()
        for name in ("walk", "turn"):
            random_motion(20, 30.0, seed=number).save(folder / f"{name}.npz")
    random_motion(20, 30.0).save(made[0] / "alone.npz")
    return made


def votes(path: Path, chosen: str, study: str = "one") -> Path:
    rows = [{"pair": f"p{i}", "left": "ab"[i % 2], "chosen": c, "seconds": 2.5} for i, c in enumerate(chosen)]
    path.write_text(json.dumps({"kind": "motionrt study", "study": study, "a": "ours", "b": "theirs", "votes": rows}))
    return path


def data_of(page: Path) -> dict:
    found = re.search(r"const study = (\{.*\});\n", page.read_text())
    assert found is not None
    return dict(json.loads(found[1]))


def test_files_of_one_name_are_a_pair_and_others_are_left_out(folders: tuple[Path, Path]) -> None:
    assert [pair.name for pair in find_pairs(*folders)] == ["turn", "walk"]


def test_pairs_are_brought_to_one_rate_and_a_bearable_length(tmp_path: Path) -> None:
    slow, fast = (walking(40 * int(fps), fps=fps).save(tmp_path / f"{fps}.npz") for fps in (20.0, 30.0))
    (pair,) = find_pairs(slow, fast)
    assert pair.a.fps == pair.b.fps == 30.0
    assert pair.a.duration <= 30.0 >= pair.b.duration


@pytest.mark.parametrize(("a", "b", "told"), [("ours", "nowhere", "nowhere"), ("ours", "ours/walk.npz", "folder")])
def test_wrong_folders_are_told_of(folders: tuple[Path, Path], a: str, b: str, told: str) -> None:
    with pytest.raises((MotionFileNotFoundError, InvalidInputError), match=told):
        find_pairs(folders[0].parent / a, folders[0].parent / b)


def test_folders_without_a_common_name_say_how_to_name_files(folders: tuple[Path, Path], tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(InvalidInputError, match="name files alike"):
        find_pairs(folders[0], tmp_path / "empty")


def test_the_page_holds_the_joints_to_the_millimetre(folders: tuple[Path, Path], tmp_path: Path) -> None:
    pairs = find_pairs(*folders)
    page = write_study(pairs, tmp_path / "study.html", names=("ours", "theirs"))
    shown = np.array(data_of(page)["pairs"][1]["a"]["frames"]).reshape(20, 24, 3) / 1000
    joints = pairs[1].a.positions()
    np.testing.assert_allclose(shown, joints - joints[0, 0] * [1, 0, 1], atol=0.0006)


def test_the_page_asks_for_nothing_from_elsewhere_and_its_data_cannot_end_its_script(
    folders: tuple[Path, Path], tmp_path: Path
) -> None:
    page = write_study(find_pairs(*folders), tmp_path / "s.html", question="</script><b>more</b> natural?")
    text = page.read_text()
    assert text.count("</script>") == 1
    assert not re.search(r"https?://|src=|@import", text)
    assert data_of(page)["question"] == "</script><b>more</b> natural?"


def test_a_page_of_another_suffix_or_without_pairs_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="html"):
        write_study([], tmp_path / "study.bvh")
    with pytest.raises(InvalidInputError, match="at least one pair"):
        write_study([], tmp_path / "study.html")


@pytest.mark.parametrize(("won", "of"), [(0, 5), (5, 5), (3, 7), (61, 100), (400, 1000)])
def test_the_interval_is_that_of_wilson(won: int, of: int) -> None:
    known = binomtest(won, of).proportion_ci(0.95, method="wilson")
    assert wilson(won, of) == pytest.approx((known.low, known.high), abs=1e-9)


def test_nothing_counted_leaves_everything_open() -> None:
    assert wilson(0, 0) == (0.0, 1.0)
    with pytest.raises(InvalidInputError, match="no count"):
        wilson(3, 2)


def test_votes_of_several_people_are_added_up(tmp_path: Path) -> None:
    count = count_votes([votes(tmp_path / "1.json", "aab"), votes(tmp_path / "2.json", "aaaab")])
    assert (count.people, count.votes, count.for_a, count.share) == (2, 8, 6, 0.75)
    assert (count.a, count.b) == ("ours", "theirs")
    assert count.low < 0.75 < count.high


def test_votes_of_different_studies_are_not_mixed(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="different studies"):
        count_votes([votes(tmp_path / "1.json", "a"), votes(tmp_path / "2.json", "a", study="two")])


LISTS = json.dumps(
    {"kind": "motionrt study", "study": "s", "a": "x", "b": "y", "votes": [{"pair": "p", "left": [], "chosen": {}}]}
)


@pytest.mark.parametrize(
    "text", ["", "[]", '{"kind": "motionrt study"}', "[" * 100_000, '{"votes": [{"chosen": 1}]}', LISTS]
)
def test_what_is_no_file_of_votes_is_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "votes.json"
    file.write_text(text)
    with pytest.raises(FormatError, match="no file of votes"):
        count_votes([file])


def test_the_table_has_a_row_for_every_vote(tmp_path: Path) -> None:
    rows = write_votes([votes(tmp_path / "1.json", "ab")], tmp_path / "votes.csv").read_text().splitlines()
    assert rows == ["file,pair,left,chosen,seconds", "1.json,p0,a,a,2.5", "1.json,p1,b,b,2.5"]


def test_the_command_writes_the_page_and_counts(
    folders: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "study.html"
    assert main(["study", *map(str, folders), "-o", str(page), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["pairs"] == ["turn", "walk"]
    assert (data_of(page)["a"], data_of(page)["b"]) == ("ours", "theirs")
    assert main(["study", "--count", str(votes(tmp_path / "v.json", "aaab"))]) == 0
    assert "ours was chosen in 3 of 4 votes of 1: 75.0 %" in capsys.readouterr().out


@pytest.mark.parametrize("arguments", [[], ["a"], ["a", "b"], ["a", "--count", "v.json"]])
def test_half_a_command_says_what_is_missing(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", *arguments]) == 2
    assert "folders" in capsys.readouterr().err
