"""Every command on inputs that are none: an error in a line and an exit code that is documented, never a traceback."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import pytest

from motionrt.cli import MISTAKE, _parser, main

SERVERS = {"view", "studio", "serve", "mcp", "bench", "completion", "models list", "models verify"}  # no input is read
WORDS = "HIERARCHY\nROOT \u2603\n{ steps: [\n".encode()
INPUTS = {
    "missing.bvh": None,
    "empty.glb": b"",
    "binary.bvh": bytes(range(256)) * 8,
    "words.bvh": WORDS,
    "words.yaml": WORDS,
    "folder.glb": None,
}


def leaves(parser: argparse.ArgumentParser, name: str = "") -> Iterator[tuple[str, argparse.ArgumentParser]]:
    below = [action.choices for action in parser._actions if isinstance(action.choices, dict)]
    for children in below:
        for word, child in children.items():
            yield from leaves(child, f"{name} {word}".strip())
    if not below:
        yield name, parser


COMMANDS = {name: parser for name, parser in leaves(_parser()) if name not in SERVERS}


def arguments(parser: argparse.ArgumentParser, given: str, out: str) -> list[str]:
    """The input in the place of everything that must be given, and a file to write."""
    found: list[str] = []
    for action in parser._actions:
        if action.option_strings:
            if action.required:
                found += [action.option_strings[-1], out if "output" in action.dest else given]
        elif action.dest == "second":
            found += ["-o", out]
        else:
            found += [given] * (2 if action.nargs == "+" else 1)
    return found


@pytest.mark.parametrize("kind", list(INPUTS))
@pytest.mark.parametrize("name", list(COMMANDS))
def test_what_is_no_input_is_refused_in_a_line(
    name: str, kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file, content = tmp_path / kind, INPUTS[kind]
    if kind.startswith("folder"):
        file.mkdir()
    elif content is not None:
        file.write_bytes(content)
    code = main([*name.split(), *arguments(COMMANDS[name], str(file), str(tmp_path / "out" / "made.bvh"))])
    err = capsys.readouterr().err
    assert code != MISTAKE, err
    assert code in {0, 1, 2, 3}
    assert "Traceback" not in err
    if code == 1 and err:
        assert err.startswith(("motionrt: ", "seed ", "skipped "))
