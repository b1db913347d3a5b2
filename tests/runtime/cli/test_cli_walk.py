"""``motionrt walk``."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels, stays

from motionrt import load_motion
from motionrt.cli import main
from motionrt.locomotion.bearings import facing_of
from motionrt.runtime import Runtime

RunJson = Callable[..., Any]


@pytest.fixture(autouse=True)
def character_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Runtime, "character_models", FakeCharacterModels())


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """12 x 12 m of free ground, without a YAML file; map y is -z."""
    (tmp_path / "room.pgm").write_bytes(b"P5 120 120 255\n" + bytes([254]) * 120 * 120)
    return tmp_path / "room.pgm"


def test_a_walk_is_written_and_measured(run_json: RunJson, tmp_path: Path) -> None:
    out = tmp_path / "out.bvh"
    found = run_json("walk", "--to", "-3", "8", "--no-foot-lock", "-o", out)
    motion = load_motion(out)
    np.testing.assert_allclose(motion.root[-1, [0, 2]], [-3, 8], atol=2e-3)
    assert found["path"] == str(out)
    assert found["frames"] == motion.frames
    assert found["path_length_m"] == pytest.approx(math.hypot(3, 8), abs=1e-3)
    assert found["goal_distance_m"] == pytest.approx(0, abs=1e-3)
    assert found["waypoints_reached"] == 1.0
    assert found["notes"] == []


def test_the_table_is_short(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["walk", "--to", "0", "4", "-o", str(tmp_path / "out.npz")]) == 0
    out, err = capsys.readouterr()
    lines = out.splitlines()
    assert lines[0].split() == ["measure", "value", "unit"]
    assert any(line.startswith("waypoints reached") and line.endswith("100.00  %") for line in lines)
    assert len(lines) < 12
    assert err == ""


def test_start_heading_and_speed_are_heeded(run_json: RunJson, tmp_path: Path) -> None:
    out = tmp_path / "out.bvh"
    options = ("--heading", "90", "--no-foot-lock", "-o", out)
    slow = run_json("walk", "--from", "1", "1", "--to", "1", "9", "--speed", "0.8", *options)
    motion = load_motion(out)
    np.testing.assert_allclose(motion.root[0, [0, 2]], [1, 1], atol=2e-3)
    assert facing_of(motion) == pytest.approx(math.pi / 2, abs=0.01)
    fast = run_json("walk", "--from", "1", "1", "--to", "1", "9", "--speed", "1.6", *options)
    assert slow["seconds"] > 1.3 * fast["seconds"]


def test_a_path_is_walked(run_json: RunJson, tmp_path: Path) -> None:
    (tmp_path / "way.csv").write_text("2,1\n2,5\n4,5\n", encoding="utf-8")
    found = run_json("walk", "--path", tmp_path / "way.csv", "-o", tmp_path / "out.bvh")
    assert found["path_length_m"] == 6
    np.testing.assert_allclose(load_motion(tmp_path / "out.bvh").root[0, [0, 2]], [2, 1], atol=2e-3)


def test_a_scene_is_planned_through(run_json: RunJson, room: Path, tmp_path: Path) -> None:
    found = run_json(
        "walk", "--scene", room, "--resolution", "0.1", "--from", "2", "-2", "--to", "9", "-9", "-o", tmp_path / "o.bvh"
    )
    assert found["path_length_m"] == pytest.approx(9.9, abs=0.1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--to", "0", "0"], "already: nothing to walk"),
        (["--to", "1", "5", "--speed", "60"], "speed must lie between"),
        (["--to", "1", "5", "--scene", "none.obj"], "none.obj"),
        (["--path", "none.csv"], "none.csv"),
    ],
)
def test_an_error_is_one_line_and_exit_code_one(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["walk", *arguments, "-o", str(tmp_path / "out.bvh")]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
    assert not (tmp_path / "out.bvh").exists()


def test_a_character_that_is_stuck_is_exit_code_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Runtime, "character_models", FakeCharacterModels(stays))
    assert main(["walk", "--to", "0", "9", "-o", str(tmp_path / "out.bvh")]) == 1
    assert "the character stays" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [[], ["--to", "1", "2"], ["--to", "1", "-o", "x.bvh"], ["--to", "1", "2", "--path", "p.csv", "-o", "x.bvh"]],
)
def test_wrong_usage_is_exit_code_two(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["walk", *arguments]) == 2
    assert "(see 'motionrt walk --help')" in capsys.readouterr().err
