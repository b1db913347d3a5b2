"""Broken BVH files: one FormatError each, with file, line and reason."""

from __future__ import annotations

from pathlib import Path

import pytest
from mini_files import BVH, write

from motionrt.errors import FormatError
from motionrt.formats import read_bvh

LAST = "1 2 3 90 0 0 0 0 90 0 90 0\n"


def line_of(fragment: str) -> int:
    return BVH[: BVH.index(fragment)].count("\n") + 1


def failure(tmp_path: Path, text: str | bytes) -> FormatError:
    path = write(tmp_path / "broken clip.bvh", text)
    with pytest.raises(FormatError) as caught:
        read_bvh(path)
    assert caught.value.path == path
    assert str(path) in str(caught.value)
    return caught.value


@pytest.mark.parametrize(
    ("old", "new", "line", "reason"),
    [
        ("90 0 90 0\n", "90 0 oops 0\n", line_of(LAST), "expected a number, found 'oops'"),
        ("90 0 90 0\n", "90 0 nan 0\n", line_of(LAST), "'nan' is not a finite number"),
        ("90 0 90 0\n", "90 0 -inf 0\n", line_of(LAST), "'-inf' is not a finite number"),
        ("90 0 90 0\n", "90 0 1e400 0\n", line_of(LAST), "'1e400' is not a finite number"),
        ("90 0 90 0\n", "90 0 1e20 0\n", line_of(LAST), "1e20 is too large"),
        ("90 0 90 0\n", "90 0 90,5 0\n", line_of(LAST), "13 values on this line instead of 12"),  # commas part numbers
        ("90 0 90 0\n", "90 0 90 0 1\n", line_of(LAST), "13 values on this line instead of 12"),
        ("Frames: 2", "Frames: -2", line_of("Frames: 2"), "the number of frames is '-2'"),
        ("Frames: 2", "Frames: two", line_of("Frames: 2"), "the number of frames is 'two'"),
        ("Frames: 2", "Frames:", line_of("Frames: 2"), "the number of frames is ''"),
        ("Frames: 2\n", "", line_of("Frames: 2"), "expected 'Frames:', found 'Frame Time: 0.033333'"),
        ("Frame Time: 0.033333\n", "", line_of("Frame Time"), "expected 'Frame Time:'"),
        ("0.033333", "0", line_of("Frame Time"), "frame time 0 is not between"),
        ("0.033333", "-0.03", line_of("Frame Time"), "give fps= to replace it"),
        ("0.033333", "nan", line_of("Frame Time"), "frame time nan"),
        ("0.033333", "30", line_of("Frame Time"), "frame time 30 is not between 0.001 and 1 s"),
        ("OFFSET 0 10 0", "OFFSET 0 ten 0", line_of("OFFSET 0 10 0"), "expected a number, found 'ten'"),
        ("OFFSET 0 10 0", "OFFSET 0 10", line_of("OFFSET 0 10 0") + 1, "expected a number, found 'CHANNELS'"),
        ("OFFSET 0 10 0", "OFFSET 0 inf 0", line_of("OFFSET 0 10 0"), "not a finite number"),
        ("\t\tOFFSET 0 10 0\n", "", line_of("JOINT chest"), "joint 'chest' has no OFFSET"),
        ("CHANNELS 3 Z", "CHANNELS 3 Q", line_of("CHANNELS 3"), "unknown channel 'Qrotation'; known are"),
        ("CHANNELS 3 Z", "CHANNELS 2 Z", line_of("CHANNELS 3"), "found 'Yrotation'"),
        ("CHANNELS 3 Z", "CHANNELS many Z", line_of("CHANNELS 3"), "0 to 6 channels, not 'many'"),
        ("CHANNELS 3 Z", "CHANNELS 99 Z", line_of("CHANNELS 3"), "0 to 6 channels, not '99'"),
        ("Xposition Y", "Yposition Y", line_of("CHANNELS 6"), "'hip' lists a channel twice"),
        ("JOINT hand", "JOINT", line_of("JOINT hand"), "JOINT without a name"),
        ("JOINT hand", "BONE hand", line_of("JOINT hand"), "expected ROOT, JOINT, End Site"),
        ("ROOT hip", "JOINT hip", line_of("ROOT hip"), "'Joint hip' stands outside of any ROOT"),
        ("JOINT hand", "ROOT hand", line_of("JOINT hand"), "a second ROOT"),
        ("\t\t\tEnd Site", "\t\t\tEnd Site { End Site", line_of("End Site"), "cannot have children"),
        ("}\nMOTION", "}\n}\nMOTION", line_of("MOTION"), "a '}' too many"),
        ("}\nMOTION", "MOTION", line_of("ROOT hip"), "the '{' of 'hip' is never closed"),
        ("\t\tJOINT hand\n\t\t{\n", "\t\tJOINT hand\n", line_of("OFFSET 5") - 1, "expected '{' after 'hand'"),
    ],
)
def test_error_names_line_and_reason(tmp_path: Path, old: str, new: str, line: int, reason: str) -> None:
    assert old in BVH
    error = failure(tmp_path, BVH.replace(old, new, 1))
    assert reason in error.reason
    assert error.line == line
    assert f":{line}: " in str(error)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b" \r\n\t ", "empty"),
        (bytes(range(256)) * 10, "binary file"),
        (
            BVH[: BVH.index(LAST)].replace("Frames: 2", "Frames: 0").split("0.033333")[0].encode() + b"0.033333\n",
            "no frames",
        ),
        (b"<!DOCTYPE html><html><body>404 Not Found</body></html>", "does not start with HIERARCHY"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "git LFS"),
        (b"MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n", "does not start with HIERARCHY"),
        (b"HIERARCHY\n", "no ROOT"),
        (b"HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 0.1\n", "no ROOT"),
        (b"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\n", "ends before MOTION"),
        (b"HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n", "no joint has"),
    ],
)
def test_files_that_are_no_bvh_at_all(tmp_path: Path, content: bytes, reason: str) -> None:
    assert reason in failure(tmp_path, content).reason


def test_a_file_with_two_skeletons_is_refused(tmp_path: Path) -> None:
    second = BVH[len("HIERARCHY\n") : BVH.index("MOTION")]
    error = failure(tmp_path, BVH.replace("MOTION", second + "MOTION"))
    assert "second ROOT" in error.reason
    assert error.line == line_of("MOTION")


_WHOLE = BVH.index(LAST)


@pytest.mark.parametrize("kept", range(0, _WHOLE - 6, 5))
def test_a_file_cut_off_before_its_first_whole_frame_is_refused(tmp_path: Path, kept: int) -> None:
    failure(tmp_path, BVH[:kept])


@pytest.mark.parametrize("kept", range(_WHOLE, len(BVH) - len(" 90 0\n"), 5))
def test_a_file_cut_off_later_keeps_its_whole_frames(tmp_path: Path, kept: int) -> None:
    clip = read_bvh(write(tmp_path / "cut.bvh", BVH[:kept]))
    assert clip.frames == 1
    assert "declares 2 frames but holds 1" in clip.notes[0]


def test_control_characters_of_a_file_do_not_reach_the_terminal(tmp_path: Path) -> None:
    error = failure(tmp_path, BVH.replace("90 0 90 0\n", "90 0 \x1b[31m 0\n"))
    assert "\x1b" not in str(error)
