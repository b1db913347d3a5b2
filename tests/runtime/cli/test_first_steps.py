"""What a newcomer types first: the guide, near misses, places, outputs, shells that complete, loud and quiet."""

from __future__ import annotations

import io
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import motionrt
from motionrt.cli import _COMMANDS, _parser, console, info, main
from motionrt.cli.parsing import split_places
from motionrt.motion import Motion


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_the_command_alone_prints_a_guide_of_commands_that_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    lines = [line.split() for line in out.splitlines() if line.startswith("  motionrt ")]
    assert len(lines) >= 5
    known = _parser().format_help()
    assert all(f"\n    {words[1]} " in known for words in lines)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        (["retreive", "walk"], "retrieve"),
        (["search", "walk"], "retrieve"),
        (["play", "x.bvh"], "view"),
        (["gallery", "bild", "."], "build"),
        (["walk", "--to", "1", "2", "-o", "x.bvh", "--sped", "1"], "--speed"),
        (["completion", "bsh"], "bash"),
        (["version"], "--version"),
    ],
)
def test_a_near_miss_is_answered_with_what_was_meant(
    typed: list[str], meant: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(typed) == 2
    assert f"did you mean {meant}" in capsys.readouterr().err


def test_what_is_near_nothing_is_refused_without_a_guess(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["qqqqqq"]) == 2
    err = capsys.readouterr().err
    assert "did you mean" not in err
    assert "'motionrt --help' lists them all" in err


@pytest.mark.parametrize(
    ("typed", "read"),
    [
        (["--to", "3,-2"], ["--to", "3", "-2"]),
        (["--to=3,-2"], ["--to", "3", "-2"]),
        (["--from", "-1.5,.5"], ["--from", "-1.5", ".5"]),
        (["--from=1e1, 2"], ["--from", "1e1", "2"]),
        (["--to", "3", "2"], ["--to", "3", "2"]),
        (["--to", "hero,2.glb"], ["--to", "hero,2.glb"]),
        (["3,2", "--to=hero.glb"], ["3,2", "--to=hero.glb"]),
    ],
)
def test_a_place_is_two_numbers_with_or_without_a_comma(typed: list[str], read: list[str]) -> None:
    assert split_places(typed) == read


@pytest.mark.parametrize(("given", "code"), [([], 2), (["-o", "{out}"], 0), (["{out}"], 0), (["{out}", "-o", "y"], 2)])
def test_convert_writes_where_it_is_told_once(library: Path, tmp_path: Path, given: list[str], code: int) -> None:
    out = tmp_path / "out.bvh"
    assert main(["convert", str(library / "walk.bvh"), *(one.format(out=out) for one in given)]) == code
    assert out.exists() is (code == 0)


def test_moments_are_saved_as_they_are_in_the_file_and_only_above_a_score(
    library: Path, tmp_path: Path, run_json: Callable[..., Any]
) -> None:
    command = ("moments", "jump", library / "long.npz", "-k", 3)
    found = run_json(*command, "--min-score", -1)
    middle = sorted(moment["score"] for moment in found)[1]
    kept = run_json(*command, "--min-score", middle - 1e-5, "--save", tmp_path / "out")
    assert [one["score"] for one in kept] == [one["score"] for one in found if one["score"] >= middle - 1e-5]
    saved = sorted((tmp_path / "out").iterdir())
    assert len(saved) == len(kept)
    whole = motionrt.load_motion(library / "long.npz")
    first = round(kept[0]["start"] * whole.fps)
    part = motionrt.load_motion(saved[0])
    assert part.frames == round((kept[0]["end"] - kept[0]["start"]) * whole.fps)
    assert abs(part.root - whole.root[first : first + part.frames]).max() < 1e-6
    assert main([*map(str, command), "--min-score", "2"]) == 1


def test_models_that_are_shipped_are_listed_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["models", "list"]) == 0
    shipped = ["not shipped" not in line for line in capsys.readouterr().out.splitlines()[1:]]
    assert shipped == sorted(shipped, reverse=True)
    assert shipped[0]


def test_quiet_leaves_notes_away_and_keeps_errors(library: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (library / "broken.bvh").write_text("nothing")
    assert main(["gallery", "build", str(library), "--jobs", "1", "-q"]) == 3
    assert capsys.readouterr().err == ""
    assert main(["info", str(library / "broken.bvh"), "--quiet"]) == 1
    assert main(["info", "gone.bvh", "--quiet"]) == 1
    assert "gone.bvh" in capsys.readouterr().err


def test_verbose_tells_the_time_and_where_a_mistake_is(
    library: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["info", str(library / "walk.bvh"), "-v"]) == 0
    assert "motionrt: done in" in capsys.readouterr().err

    def fail(_: object) -> int:
        raise ZeroDivisionError

    monkeypatch.setattr(info, "run", fail)
    assert main(["info", "x.bvh"]) == 70
    with pytest.raises(ZeroDivisionError):
        main(["info", "x.bvh", "--verbose"])


def test_a_terminal_gets_a_bold_header_and_lines_that_fit_and_a_pipe_plain_whole_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("COLUMNS", "20")
    for stream, plain in ((Terminal(), False), (io.StringIO(), True)):
        monkeypatch.setattr(sys, "stdout", stream)
        console.print_table(["rank", "clip"], [["1", "日本 walk " + "x" * 40], ["10", "b"]], "><")
        lines = stream.getvalue().splitlines()
        assert lines[0].startswith("rank" if plain else "\x1b[1mrank") or sys.platform == "win32"
        assert lines[2] == "  10  b"
        assert lines[1].endswith("x" * 40 if plain else "...")
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setattr(sys, "stdout", Terminal())
    console.print_table(["rank"], [["1"]], "<")
    assert "\x1b" not in sys.stdout.getvalue()  # type: ignore[attr-defined]


def test_what_takes_a_second_counts_them_and_is_wiped(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(console, "_SHOWN_AFTER_S", 0.0)
    with console.working("thinking"):
        while "thinking ... 0 s" not in terminal.getvalue():
            time.sleep(0.01)
    assert terminal.getvalue().split("\r")[-2].strip() == ""


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash to complete in")
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["motionrt", "retr"], ["retrieve"]),
        (["motionrt", "gallery", "up"], ["update"]),
        (["motionrt", "gallery", "build", "--source"], ["--source-fps"]),
        (["motionrt", "convert", "--units", "m"], ["m", "mm"]),
    ],
)
def test_bash_completes(words: list[str], expected: list[str], tmp_path: Path) -> None:
    script = tmp_path / "motionrt.bash"
    script.write_text(_printed(["completion", "bash"]))
    ask = (
        f'. {script}; COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _motionrt; echo "${{COMPREPLY[@]}}"'
    )
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert set(expected) <= set(done.stdout.split())
    assert done.stderr == ""


def test_every_command_is_in_every_shells_script() -> None:
    names = [
        line.split()[0] for line in _parser().format_help().splitlines() if line.startswith("    ") and line[4] != " "
    ]
    assert len(names) >= len(_COMMANDS)
    for shell in ("bash", "zsh", "fish"):
        script = _printed(["completion", shell])
        assert all(name in script for name in names if name != "COMMAND")


def _printed(arguments: list[str]) -> str:
    return subprocess.run(
        [sys.executable, "-m", "motionrt", *arguments], capture_output=True, text=True, check=True
    ).stdout


def test_two_motion_files_keep_the_way_of_the_first(library: Path, tmp_path: Path) -> None:
    out = tmp_path / "both.npz"
    assert main(["compose", str(library / "walk.bvh"), str(library / "ä" / "kreis.bvh"), "-o", str(out)]) == 0
    both, first = (motionrt.load_motion(path) for path in (out, library / "walk.bvh"))
    assert isinstance(both, Motion)
    assert abs(both.root - first.root[: both.frames])[:, [0, 2]].max() < 1e-3
