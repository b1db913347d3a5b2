"""``describe``, ``moments`` and ``convert``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from motionrt import load_motion
from motionrt.cli import main
from motionrt.cli.plot import BLOCKS, PLAIN, curve_lines


def test_describe_prints_captions_of_a_file(library: Path, tmp_path: Path, run_json: Callable[..., Any]) -> None:
    captions = tmp_path / "captions.txt"
    captions.write_text("geht\nspringt hoch\nsitzt\n", encoding="utf-8")
    found = run_json("describe", library / "long.npz", "--captions", captions, "-k", 2)
    assert [list(row) for row in found] == [["rank", "score", "text", "start", "end"]] * 2
    assert {row["text"] for row in found} < {"geht", "springt hoch", "sitzt"}


def test_describe_has_a_table_and_captions_of_its_own(library: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(library / "walk.bvh"), "-k", "3"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 4


def test_moments_are_spans_in_seconds(library: Path, run_json: Callable[..., Any]) -> None:
    found = run_json("moments", "jump", library / "long.npz", "-k", 3, "--min-score", -1)
    assert [list(row) for row in found] == [["rank", "score", "start", "end"]] * 3
    assert all(0 <= row["start"] < row["end"] <= 15 for row in found)


def test_moments_have_the_lengths_of_the_windows_that_were_asked_for(
    library: Path, run_json: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    found = run_json("moments", "jump", library / "long.npz", "--windows", "100,140", "--min-score", -1)
    assert found
    assert {round(row["end"] - row["start"], 2) for row in found} <= {5.0, 7.0}
    for wrong in ("0", "ten", ""):
        assert main(["moments", "jump", str(library / "long.npz"), "--windows", wrong]) == 2
        assert "numbers of frames" in capsys.readouterr().err


def test_the_plot_follows_the_table_and_stays_out_of_json(
    library: Path, capsys: pytest.CaptureFixture[str], run_json: Callable[..., Any]
) -> None:
    assert main(["moments", "jump", str(library / "long.npz"), "-k", "1", "--plot", "--min-score", "-1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 + 6
    assert lines[-1].split() == ["0", "15.0", "s"]
    run_json("moments", "jump", library / "long.npz", "--plot")  # parses: the plot went to stderr


def test_what_does_not_happen_has_no_moment_and_nothing_is_written(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], run_json: Callable[..., Any]
) -> None:
    command = ["moments", "jump", str(library / "long.npz"), "--min-score", "0.99"]
    assert main(command) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert "no moment fits 'jump'; the nearest is " in err
    assert run_json(*command) == []
    assert main([*command, "--save", str(tmp_path / "out")]) == 1
    assert "nothing was found, so nothing is written for --save" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_plot_rises_where_the_values_do_and_marks_the_span() -> None:
    lines = curve_lines([0.0] * 20 + [1.0] * 20, fps=20.0, marked=[(1.0, 2.0)])
    assert lines[0] == "|" + " " * 20 + "█" * 20 + "|  1.000"
    assert lines[3] == "|" + "▁" * 20 + "█" * 20 + "|  0.000"
    assert lines[4] == "|" + "-" * 20 + "^" * 20 + "|"
    assert lines[5] == "0" + "2.0 s".rjust(41)


def test_a_terminal_without_blocks_gets_plain_characters() -> None:
    text = "".join(curve_lines([0.0, 0.5, 1.0], 20.0, encoding="cp1252"))
    assert not set(BLOCKS[1:]) & set(text)
    assert PLAIN[8] in text


def test_one_value_and_equal_values_are_a_plot_too() -> None:
    assert curve_lines([0.5], 20.0)[3].startswith("|▁|")


def test_convert_writes_the_other_format(library: Path, tmp_path: Path, run_json: Callable[..., Any]) -> None:
    done = run_json("convert", library / "walk.bvh", tmp_path / "walk.npz", "--fps", 10)
    motion = load_motion(tmp_path / "walk.npz", keep_first_frame=True)
    assert (motion.fps, motion.frames) == (done["fps"], done["frames"]) == (10.0, 30)


def test_convert_refuses_a_format_that_it_cannot_write(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["convert", str(library / "walk.bvh"), str(tmp_path / "walk.c3d")]) == 1
    assert ".c3d" in capsys.readouterr().err


def test_a_missing_clip_is_one_line_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", "gone.bvh"]) == 1
    err = capsys.readouterr().err
    assert err.startswith("motionrt: error: ")
    assert "gone.bvh" in err
