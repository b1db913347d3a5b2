"""The command as a shell user expects it: usage, versions, pipes, Ctrl-C, consoles that lack letters."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path

import pytest
from motions import walking

import motionrt
from motionrt.cli import console, describe, main
from motionrt.errors import MotionRTError


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "motionrt", *arguments]
    return subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)


def test_version_and_help_go_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"motionrt {motionrt.__version__}\n"
    assert main(["--help"]) == 0
    out = capsys.readouterr().out
    for name in ("retrieve", "gallery", "describe", "moments", "convert", "models", "bench"):
        assert name in out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["wlak"], "no command 'wlak'; did you mean walk? ('motionrt --help' lists them all)"),
        (["retrieve"], "missing: text (see 'motionrt retrieve --help')"),
        (["gallery"], "missing: COMMAND (see 'motionrt gallery --help')"),
        (["bench", "--threads", "0"], "--threads: counts are at least 1 (see 'motionrt bench --help')"),
        (["walk", "-o", "x.bvh"], "missing: one of --to --path (see 'motionrt walk --help')"),
        (["walk", "--to", "a", "b"], "--to: a number is wanted, not 'a' (see 'motionrt walk --help')"),
        (["walk", "--to", "1"], "--to: 2 values are wanted (see 'motionrt walk --help')"),
        (["retrieve", "a", "-k", "x"], "-k: a whole number is wanted, not 'x' (see 'motionrt retrieve --help')"),
        (["retrieve", "a", "--jsn"], "unknown: --jsn; did you mean --json? (see 'motionrt retrieve --help')"),
        (["render", "a", "-o", "x.png", "--theme", "red"], "--theme cannot be 'red'; can be: light, dark"),
    ],
)
def test_wrong_usage_is_one_line_on_stderr_and_exit_code_two(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"motionrt: error: {said}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["generate", "walk", "--seconds", "99", "-o", "x.bvh"], "--seconds must be a number from 0.5 to 10, not 99.0"),
        (["retrieve", "walk", "-k", "0"], "-k must be at least 1, not 0"),
        (["walk", "--to", "1", "1", "--speed", "99", "-o", "x.bvh"], "--speed must lie between 0.3 and 5 m/s"),
        (["compose", "clip.npz", "wave", "--joint", "-o", "x.bvh"], "--joint is for texts alone"),
        (["compose", "clip.npz", "-o", "x.bvh"], "two or more motions, files or texts, not of 'clip.npz' alone"),
        (["convert", "clip.npz", "x.glb", "--units", "m", "--t-pose"], "--units and --t-pose are for a .bvh;"),
        (["info", "clip.npz", "--source-fps", "0"], "--source-fps must be a positive number, not 0.0"),
        (["resample", "clip.npz", "x.bvh", "--fps", "0"], "--fps must be a positive number, not 0.0"),
        (["rig", "map", "clip.bvh", "--mapping", "m.yaml"], "the mapping of left_hip: the rig has no joint 'nope'"),
        (["rig", "map", "clip.bvh", "-o", "none/x.yaml"], "there is no folder none; make it first"),
        (["walk", "--path", "none.csv", "-o", "x.bvh"], "no such file: none.csv"),
        (["perform", "none.yaml", "-o", "x.bvh"], "none.yaml: there is no such file"),
    ],
)
def test_errors_are_in_the_words_of_the_command_line(
    arguments: list[str],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    walking(20).save("clip.npz")
    walking(20).save("clip.bvh")
    Path("m.yaml").write_text("left_hip: nope\n")
    assert main(arguments) == 1
    assert said in capsys.readouterr().err


def test_the_module_runs_as_a_program_without_a_traceback(tmp_path: Path) -> None:
    done = run("gallery", "info", str(tmp_path))
    assert done.returncode == 1
    assert done.stdout == ""
    assert done.stderr.startswith("motionrt: error: no gallery in ")
    assert done.stderr.count("\n") == 1


HELP = """
import sys
from motionrt.cli import main
main(["--help"])
print([name for name in ("numpy", "scipy", "onnxruntime", "yaml") if name in sys.modules], file=sys.stderr)
"""


def test_help_imports_neither_numpy_nor_onnxruntime() -> None:
    done = subprocess.run([sys.executable, "-c", HELP], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"


def test_an_error_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def fail(_: object) -> int:
        raise MotionRTError("two\nlines")

    monkeypatch.setattr(describe, "run", fail)
    assert main(["describe", "x.bvh"]) == 1
    assert capsys.readouterr().err == "motionrt: error: two lines\n"


def test_ctrl_c_ends_quietly(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupt(_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(describe, "run", interrupt)
    assert main(["describe", "x.bvh"]) == 130
    assert capsys.readouterr().err == ""


@pytest.mark.skipif(sys.platform == "win32", reason="closing a pipe early is a POSIX affair")
def test_a_reader_that_stops_early_causes_no_traceback() -> None:
    command = [sys.executable, "-m", "motionrt", "retrieve", "--help"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.stderr is not None
        errors = process.stderr.read()
    assert b"Traceback" not in errors
    assert b"Exception" not in errors


def console_of(encoding: str, monkeypatch: pytest.MonkeyPatch) -> io.BytesIO:
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding, write_through=True))
    console.prepare_streams()
    return raw


@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "utf-8"])
def test_names_that_the_console_lacks_are_escaped_and_json_stays_json(
    encoding: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = ["日本 walk.bvh", "\U0001f600.bvh", "caf\udce9.bvh", "ü.bvh"]
    raw = console_of(encoding, monkeypatch)
    console.print_table(["clip"], [[name] for name in names], "<")
    assert raw.getvalue().count(b".bvh") == 4
    raw = console_of(encoding, monkeypatch)
    console.print_json(names)
    assert json.loads(raw.getvalue().decode(encoding)) == names


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_progress_is_drawn_on_a_terminal_and_wiped_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    progress = console.Progress()
    progress(1, 2, "a.bvh")
    assert "[############............] 1/2 a.bvh" in terminal.getvalue()
    progress(2, 2, "b.bvh")
    assert terminal.getvalue().split("\r")[-2].strip() == ""


def test_progress_is_silent_in_a_pipe(monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = io.StringIO()
    monkeypatch.setattr(sys, "stderr", pipe)
    console.Progress()(1, 2, "a.bvh")
    assert pipe.getvalue() == ""
