"""``motionrt perform``."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels

from motionrt import load_motion
from motionrt.cli import main
from motionrt.runtime import Runtime

RunJson = Callable[..., Any]

SCRIPT = """\
start: {at: [0, 0], heading: 0}
foot_lock: false
steps:
  - walk: {to: [0, 6]}
  - act: {name: grab, keypoints: {right_hand: [1.0, 1.2, 9.0]}, heading: 0, hold: 1}
  - walk: {to: [5, 9]}
"""


@pytest.fixture(autouse=True)
def character_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Runtime, "character_models", FakeCharacterModels())


@pytest.fixture
def script(tmp_path: Path) -> Path:
    (tmp_path / "script.yaml").write_text(SCRIPT, encoding="utf-8")
    return tmp_path / "script.yaml"


def test_a_script_is_performed_and_its_timeline_told(run_json: RunJson, script: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.bvh"
    found = run_json("perform", script, "-o", out)
    motion = load_motion(out)
    assert found["frames"] == motion.frames
    np.testing.assert_allclose(motion.root[-1, [0, 2]], [5, 9], atol=2e-3)
    segments = found["segments"]
    assert [segment["start"] for segment in segments[1:]] == [segment["end"] for segment in segments[:-1]]
    assert segments[-1]["end"] == pytest.approx(found["seconds"], abs=1e-3)
    (hold,) = [segment for segment in segments if segment["name"] == "grab" and segment["kind"] == "hold"]
    assert hold["end"] - hold["start"] == pytest.approx(1.0, abs=1e-3)
    assert hold["keypoints_cm"]["right_hand"] < 1
    assert found["keypoint_max_cm"] == hold["keypoints_cm"]["right_hand"]


def test_people_get_a_timeline_and_measures(script: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["perform", str(script), "-o", str(tmp_path / "out.bvh")]) == 0
    out, err = capsys.readouterr()
    timeline, measures = out.split("\n\n")
    assert timeline.splitlines()[0].split() == ["start", "end", "part", "step", "measure"]
    assert any(line.split()[2:4] == ["hold", "grab"] for line in timeline.splitlines())
    assert "off the keypoints, most" in measures
    assert err == ""


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_bar_shows_how_far_it_is(script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    assert main(["perform", str(script), "-o", str(tmp_path / "out.bvh")]) == 0
    shown = terminal.getvalue()
    assert "/100 walk to 0.0, 6.0" in shown
    assert "/100 grab" in shown
    assert shown.split("\r")[-2].strip() == ""  # wiped at the end


def test_a_slip_in_the_script_is_one_line_and_exit_code_one(
    script: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script.write_text(SCRIPT.replace("- act:", "- akt:"), encoding="utf-8")
    assert main(["perform", str(script), "-o", str(tmp_path / "out.bvh")]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"motionrt: error: {script}:5: step 2: unknown action 'akt'; did you mean act?\n"


def test_what_cannot_be_done_names_the_step(script: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script.write_text(SCRIPT.replace("1.2, 9.0", "4.5, 9.0"), encoding="utf-8")
    assert main(["perform", str(script), "-o", str(tmp_path / "out.bvh")]) == 1
    assert "step 2 ('grab'): no plausible pose" in capsys.readouterr().err


def test_a_script_is_needed(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["perform", "-o", "x.bvh"]) == 2
    assert "(see 'motionrt perform --help')" in capsys.readouterr().err
    assert main(["perform", str(tmp_path / "none.yaml"), "-o", "x.bvh"]) == 1
    assert "there is no such file" in capsys.readouterr().err
