"""The commands motionrt view and motionrt studio as processes: their messages and their end."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import urllib.request
from functools import partial
from pathlib import Path

import pytest

from motionrt.cli import main


def test_ctrl_c_ends_the_server_cleanly(viser: None, walk_file: Path) -> None:
    command = [sys.executable, "-m", "motionrt", "view", str(walk_file), "--no-browser", "--port", "0"]
    # Ctrl-C is ignored where tests run in the background
    at_start = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    running = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=at_start)  # noqa: PLW1509
    try:
        assert running.stderr is not None
        url = running.stderr.readline().split()[0]
        with urllib.request.urlopen(url, timeout=20) as answer:
            assert answer.status == 200
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=20)
    finally:
        running.kill()
    assert running.returncode == 0
    assert (out, err.strip()) == ("", "")


@pytest.mark.parametrize("command", ["view", "studio"])
def test_a_taken_port_is_one_line_and_exit_code_1(
    viser: None, command: str, walk_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        assert main([command, str(walk_file), "--no-browser", "--port", str(port)]) == 1
    assert f"cannot serve on 127.0.0.1:{port}" in capsys.readouterr().err


def test_no_clip_that_can_be_read_is_an_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", str(tmp_path / "none.bvh"), "--no-browser"]) == 1
    assert "none.bvh" in capsys.readouterr().err


def test_without_viser_the_message_says_how_to_get_it(walk_file: Path) -> None:
    hidden = "import sys; sys.modules['viser'] = None; from motionrt.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", hidden, "view", str(walk_file), "--no-browser", "--port", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, env=os.environ)
    assert done.returncode == 1
    assert 'pip install "motionrt[studio]"' in done.stderr
