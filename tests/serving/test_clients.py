"""The client examples, run as a user runs them; and the commands that serve."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from service import TOKEN, Served

from motionrt import load_motion
from motionrt.cli import main
from motionrt.cli import serve as command

CLIENTS = Path(__file__).parents[2] / "examples" / "clients"


def run(served: Served, folder: Path, *words: str) -> str:
    environment = {**os.environ, "MOTIONRT_URL": served.url, "MOTIONRT_TOKEN": TOKEN}
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_python_client_finds_fetches_and_makes(served: Served, tmp_path: Path) -> None:
    out = run(served, tmp_path, sys.executable, str(CLIENTS / "client.py"), "walks")
    assert out.count(" s\n") == 3
    assert load_motion(tmp_path / "found.glb").frames > 10
    assert load_motion(tmp_path / "made.glb").duration == pytest.approx(2.0, abs=0.05)


def test_the_javascript_client_finds_and_walks(served: Served, tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node.js is not installed")
    version = subprocess.run([node, "--version"], capture_output=True, text=True, check=True).stdout
    flags = ["--experimental-websocket"] if int(version.strip("v\n").split(".")[0]) < 22 else []
    out = run(served, tmp_path, node, *flags, str(CLIENTS / "client.mjs"), "walks")
    assert "bytes of .glb" in out
    assert "frame 30: pelvis at" in out


def test_the_command_serves_named_galleries_with_a_token_that_it_prints(
    library: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("fastapi", reason="the extra serve is not installed")
    from motionrt import serving

    seen: dict[str, object] = {}
    monkeypatch.delenv(command.TOKEN, raising=False)
    monkeypatch.setattr(serving, "serve", lambda app, **options: seen.update(options, app=app))
    assert main(["serve", "--gallery", f"own={library}", "--port", "0"]) == 0
    assert (seen["host"], seen["port"]) == ("127.0.0.1", 0)
    printed = capsys.readouterr().err
    assert f"token {seen['app']._token}" in printed  # type: ignore[attr-defined]
    monkeypatch.setenv(command.TOKEN, "a secret")
    assert main(["serve", "--gallery", str(library), "--port", "0"]) == 0
    assert seen["app"]._token == "a secret"  # type: ignore[attr-defined]
    assert "a secret" not in capsys.readouterr().err


def test_a_gallery_that_is_none_is_told_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serve", "--gallery", str(tmp_path)]) == 1
    assert "motionrt gallery build" in capsys.readouterr().err


def test_without_the_extra_the_error_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert main(["serve"]) == 1
    assert 'pip install "motionrt[serve]"' in capsys.readouterr().err
    assert main(["mcp"]) == 1
    assert 'pip install "motionrt[mcp]"' in capsys.readouterr().err
