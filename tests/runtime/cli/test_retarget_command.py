"""``motionrt retarget``, and GLB through ``motionrt convert``."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from characters import bvh_text, character
from glb_files import Player, glb
from motions import random_motion, walking

from motionrt import load_motion
from motionrt.cli import main
from motionrt.formats import load_rig


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    return walking(20, 30).save(tmp_path / "clip.bvh")


def test_a_clip_goes_onto_a_character(tmp_path: Path, clip: Path, run_json: Callable[..., Any]) -> None:
    rig = glb(character("mixamo")).save(tmp_path / "rig.glb")
    said = run_json("retarget", clip, "--to", rig, "-o", tmp_path / "out.glb")
    joints = len(character("mixamo").names)
    assert {key: said[key] for key in ("frames", "fps", "joints")} == {"frames": 20, "fps": 30, "joints": joints}
    assert said["units_per_metre"] == pytest.approx(1.104, abs=0.01)
    assert len(Player(tmp_path / "out.glb").times) == 20


def test_it_says_in_a_line_what_it_wrote(tmp_path: Path, clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rig = tmp_path / "rig.bvh"
    rig.write_text(bvh_text(character("cmu", extras=False)), encoding="utf-8")
    assert (
        main(["retarget", str(clip), "--to", str(rig), "-o", str(tmp_path / "out.bvh"), "--fps", "60", "--t-pose"]) == 0
    )
    assert capsys.readouterr().out == f"{tmp_path / 'out.bvh'}: 39 frames, 0.65 s at 60 fps, 22 joints\n"
    assert load_rig(tmp_path / "out.bvh").frames == 40


def test_root_motion_and_mappings_are_handed_on(tmp_path: Path, clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    person = character("unreal", root="root")
    rig, out, names = glb(person).save(tmp_path / "rig.glb"), tmp_path / "out.glb", tmp_path / "names.json"
    for option in (["--root-motion"], ["--root-motion", "root"]):
        assert main(["retarget", str(clip), "--to", str(rig), "-o", str(out), *option]) == 0
        assert (0, "translation") in Player(out).tracks
    names.write_text(json.dumps({"left_hip": "thigh_x"}), encoding="utf-8")
    assert main(["retarget", str(clip), "--to", str(rig), "-o", str(out), "--rig-mapping", str(names)]) == 1
    assert "the rig has no joint 'thigh_x'" in capsys.readouterr().err


def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, clip: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "rig.glb").write_bytes(b"no rig")
    assert main(["retarget", str(clip), "--to", str(tmp_path / "rig.glb"), "-o", str(tmp_path / "out.glb")]) == 1
    assert "not a GLB file" in capsys.readouterr().err
    assert not (tmp_path / "out.glb").exists()


def test_convert_reads_and_writes_glb(tmp_path: Path, run_json: Callable[..., Any]) -> None:
    clip = random_motion(20, 30).save(tmp_path / "clip.bvh")
    run_json("convert", clip, tmp_path / "out.glb")
    said = run_json("convert", tmp_path / "out.glb", tmp_path / "back.bvh", "--units", "m", "--t-pose")
    assert said["frames"] == 20
    assert load_rig(tmp_path / "back.bvh").frames == 21
    assert abs(load_motion(tmp_path / "back.bvh").positions() - load_motion(clip).positions()).max() < 1e-4
