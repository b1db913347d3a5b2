"""``motionrt render``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from motions import walking

from motionrt.cli import main

pytest.importorskip("PIL", reason="Pillow, of the extra render, is not installed")


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    return walking(30).save(tmp_path / "walk.bvh")


def test_the_command_draws_and_says_what_it_wrote(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = clip.with_suffix(".png")
    assert main(["render", str(clip), "-o", str(out), "--size", "300", "--theme", "dark", "--no-grid"]) == 0
    assert capsys.readouterr().out.strip() == f"{out}: {max(1, round(out.stat().st_size / 1000))} kB"


def test_json_names_the_file_and_its_size(clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = clip.with_suffix(".gif")
    assert main(["render", str(clip), str(clip), "-o", str(out), "--size", "200x100", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"path": str(out), "bytes": out.stat().st_size}


@pytest.mark.parametrize(
    ("arguments", "code"),
    [(["--size", "wide"], 2), (["--layout", "round"], 2), (["--colour", "left"], 1), (["--camera", "up"], 1)],
)
def test_wrong_options_are_explained(
    clip: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], code: int
) -> None:
    assert main(["render", str(clip), "-o", str(clip.with_suffix(".png")), *arguments]) == code
    assert arguments[1] in capsys.readouterr().err
