"""Names of files to be written: what is wrong with one is told before anything is made, and how to name one."""

from __future__ import annotations

from pathlib import Path

import pytest
from motions import walking

from motionrt.cli import main
from motionrt.errors import InvalidInputError
from motionrt.untrusted.outputs import checked_output

KINDS = (".bvh", ".glb")


def test_a_file_of_a_known_kind_in_a_folder_that_is_there_is_taken_whatever_its_case(tmp_path: Path) -> None:
    assert checked_output(str(tmp_path / "a.GLB"), KINDS) == tmp_path / "a.GLB"
    assert checked_output(tmp_path / "a.anything", ()) == tmp_path / "a.anything"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("", r"is a folder; give a file in it, as in .*motion\.bvh"),
        ("inside", r"is a folder; give a file in it, as in .*inside.motion\.bvh"),
        ("wave", r"has no suffix, which would say its kind: name it wave\.bvh, for instance; can be: \.bvh, \.glb"),
        ("wave.", r"name it wave\.bvh"),
        (".bvh", r"name it \.bvh\.bvh"),
        ("wave.mov", r"a file '\.mov' cannot be written; can be: \.bvh, \.glb"),
        ("none/wave.bvh", r"there is no folder .*none; make it first"),
        ("file/wave.bvh", r"file is a file, not a folder"),
    ],
)
def test_a_name_that_cannot_be_written_is_told_how_to_be_one(tmp_path: Path, name: str, said: str) -> None:
    (tmp_path / "inside").mkdir()
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidInputError, match=said):
        checked_output(tmp_path / name, KINDS)


@pytest.mark.parametrize("name", ["inside.bvh", "wave", "none/wave.bvh"])
def test_motions_say_the_same_when_they_are_saved(tmp_path: Path, name: str) -> None:
    (tmp_path / "inside.bvh").mkdir()
    with pytest.raises(InvalidInputError, match=r"is a folder|has no suffix|there is no folder"):
        walking(3).save(tmp_path / name)


def test_a_command_says_it_before_it_reads_or_makes_anything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    nothing = str(tmp_path / "none.bvh")  # would be told of, if it were read first
    for verb, more in (
        ("render", []),
        ("compose", []),
        ("retarget", ["--to", "hero.glb"]),
        ("walk", ["--to", "1", "1"]),
    ):
        given = [] if verb == "walk" else [nothing]
        assert main([verb, *given, *more, "-o", str(tmp_path)]) == 1
        assert "is a folder; give a file in it" in capsys.readouterr().err
