"""Everything that the README shows can be copied and works: its blocks and the commands in its text, in their order."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from shell import shell_environment

tomllib = pytest.importorskip("tomllib", reason="reading pyproject.toml needs Python 3.11")
ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(bash|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`(motionrt [^`]+)`")
SERVERS = ("motionrt view", "motionrt studio")
SHORTER = {"motionrt bench": "motionrt bench --quick --only text --threads 1"}  # whole, it takes minutes
ELSEWHERE = ("pip ", "pipx ", "uvx ")  # .ci/run installs; here it is checked that what they name is there


def shown() -> Iterator[tuple[str, str]]:
    """Language and text of everything that can be copied, in the order of the README."""
    text = BLOCK.sub(lambda found: f"\0{found.start()}\0", README)
    blocks = {found.start(): (found[1], found[2]) for found in BLOCK.finditer(README)}
    for found in re.finditer(rf"\0(\d+)\0|{INLINE.pattern}", text):
        if found[1] is not None:
            language, body = blocks[int(found[1])]
            yield from ((language, line) for line in ([body] if language == "python" else body.splitlines()))
        else:
            yield "bash", found[2]


SHOWN = list(dict.fromkeys(one for one in shown() if one[1].strip()))


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder like a fresh clone, in which the README is followed from top to bottom."""
    folder = tmp_path_factory.mktemp("clone")
    (folder / "examples").symlink_to(ROOT / "examples")
    return folder


@pytest.mark.skipif(sys.platform == "win32", reason="the README's commands are run by a POSIX shell")
@pytest.mark.parametrize(("language", "text"), SHOWN, ids=[text.splitlines()[0][:60] for _, text in SHOWN])
def test_what_the_readme_shows_works_as_it_is_copied(language: str, text: str, place: Path) -> None:
    if text.startswith(ELSEWHERE):
        check_installation(text)
        return
    if text.startswith("motionrt render") or text.startswith(SERVERS):
        name = "PIL" if "render" in text else "viser"
        pytest.importorskip(name, reason=f"this command of the README needs an extra: {name} is not installed")
    if text.startswith(SERVERS):
        serve_and_stop(text, place)
        return
    command = ["bash", "-c", SHORTER.get(text, text)] if language == "bash" else [sys.executable, "-c", text]
    done = subprocess.run(command, cwd=place, env=shell_environment(place), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for out in re.findall(r"-o (\S+)|save\(\"([^\"]+)\"\)", text):
        assert (place / (out[0] or out[1])).stat().st_size > 0


def check_installation(text: str) -> None:
    """Extras that are named exist; the project that is named is this one."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        extras = tomllib.load(file)["project"]["optional-dependencies"]
    named = [one for group in re.findall(r"\[([\w,]+)\]", text) for one in group.split(",")]
    assert set(named) <= set(extras)
    assert "'" not in text, "single quotes are no quotes to cmd.exe"
    assert re.search(r'(^| )"?\.("|\[| |$)', text), f"{text} installs something else"


def serve_and_stop(text: str, place: Path) -> None:
    """The page is announced, and Ctrl-C ends it without complaint."""
    process = subprocess.Popen(
        ["bash", "-c", f"exec {text} --port 0"],
        cwd=place,
        env=shell_environment(place),
        stderr=subprocess.PIPE,
        text=True,
        # Ctrl-C is ignored where tests run in the background
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )
    assert process.stderr is not None
    try:
        line = process.stderr.readline()
        assert line.startswith("http://127.0.0.1:"), line
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.stderr.close()


def test_the_readme_shows_every_extra_that_users_need_once() -> None:
    with (ROOT / "pyproject.toml").open("rb") as file:
        extras = set(tomllib.load(file)["project"]["optional-dependencies"]) - {"train", "export", "dev"}
    table = README[README.index("| extra, as in") :].split("\n\n")[0]
    rows = [re.findall(r"`([\w]+)`", line.split("|")[1]) for line in table.splitlines()[2:]]
    assert sorted(name for row in rows for name in row) == sorted(extras)


def test_every_link_and_picture_of_the_readme_is_there() -> None:
    for target in re.findall(r"\]\(([^)#]+)", README):
        assert target.startswith("http") or (ROOT / target).exists(), target
