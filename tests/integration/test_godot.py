"""A GLB of motionrt in Godot: imported without its window, its bones are where motionrt's joints are."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

import motionrt

SCRIPT = Path(__file__).parents[2] / "examples" / "engines" / "godot" / "joints.gd"
SECONDS = (0.0, 1.6, 3.2)  # Godot 3 samples imported animations at 15 fps unless told otherwise

pytestmark = pytest.mark.skipif(
    shutil.which("godot3-server") is None, reason="no Godot (Debian: apt install godot3-server)"
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with a motion that the editor has imported."""
    gallery = motionrt.Runtime().gallery()
    gallery.motion(gallery.clips[0].id).resample(30.0).save(tmp_path / "walk.glb")
    (tmp_path / "project.godot").write_text('config_version=4\n[application]\nconfig/name="check"\n')
    shutil.copy(SCRIPT, tmp_path / SCRIPT.name)
    editor = subprocess.Popen(
        ["godot3-server", "--path", tmp_path, "--editor", "--quit"],
        env={**os.environ, "HOME": str(tmp_path)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        end = time.monotonic() + 240
        while time.monotonic() < end and not list((tmp_path / ".import").glob("walk.glb-*.md5")):
            time.sleep(0.2)
    finally:
        editor.kill()  # this version's editor does not quit by itself where it has no window
        editor.wait()
    return tmp_path


def test_bones_are_where_the_joints_are(project: Path) -> None:
    command = ["godot3-server", "--path", str(project), "-s", SCRIPT.name, "--", "res://walk.glb", *map(str, SECONDS)]
    environment = {**os.environ, "HOME": str(project)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=240)
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("joints ")]
    told, motion = json.loads(line.removeprefix("joints ")), motionrt.load_motion(project / "walk.glb")
    assert told["seconds"] == pytest.approx((motion.frames - 1) / 30, abs=1e-3)
    for seconds, places in zip(SECONDS, told["joints"], strict=True):
        names = [name.replace("spine", "spine_") for name in motion.skeleton.names]  # as Godot 3 writes them
        found = np.array([places[name] for name in names])
        np.testing.assert_allclose(
            found, motion.positions()[round(30 * seconds)], atol=1e-3
        )  # it samples keys at 15 fps
