"""A real Blender, without a window: our files have the joints where we say, and the add-on works end to end."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zipfile
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import motionrt
from motionrt.motion.rotations import axis_angle_to_matrix

SCRIPTS = Path(__file__).parent / "blender"
ADDON = Path(__file__).parents[2] / "integrations" / "blender"
NO_BLENDER = "needs Blender: apt-get install blender python3-numpy"

pytestmark = pytest.mark.skipif(shutil.which("blender") is None, reason=NO_BLENDER)


def blender(script: str, *arguments: Path | str, env: dict[str, str] | None = None) -> dict[str, Any]:
    """What a script, run in Blender, wrote into its last argument."""
    command = ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python-use-system-env"]
    command += ["--python", str(SCRIPTS / script), "--", *map(str, arguments)]
    done = subprocess.run(
        command, capture_output=True, text=True, encoding="utf-8", check=False, env={**system_python(), **(env or {})}
    )
    assert done.returncode == 0, f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return json.loads(Path(arguments[-1]).read_text(encoding="utf-8"))


def system_python() -> dict[str, str]:
    """Debian's Blender belongs to Debian's Python, whatever else is on the path."""
    return {**os.environ, "PATH": f"/usr/bin:/bin:{os.environ['PATH']}", "PYTHONPATH": ""}


@lru_cache(maxsize=1)
def python_of_blender() -> str:
    code = "import sys; print('PYTHON', '%d.%d' % sys.version_info[:2])"
    done = subprocess.run(
        ["blender", "--background", "--factory-startup", "--python-expr", code],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
        env=system_python(),
    )
    return next(line.split()[1] for line in done.stdout.splitlines() if line.startswith("PYTHON"))


def tumbling(frames: int = 40) -> motionrt.Motion:
    """Every joint turns another way, the root travels: nothing of a skeleton or of the axes can be mixed up unseen."""
    rng = np.random.default_rng(7)
    time = np.linspace(0, 1, frames)[:, None, None]
    turns = axis_angle_to_matrix(rng.uniform(-1.2, 1.2, (1, 24, 3)) * time + rng.uniform(-0.5, 0.5, (1, 24, 3)))
    root = np.array([0.3, 0.9, -0.2]) + time[:, 0] * np.array([1.0, 0.2, 2.0])
    return motionrt.Motion(turns.astype(np.float32), root.astype(np.float32), 30.0)


@pytest.mark.parametrize(("suffix", "scale"), [(".bvh", 0.01), (".glb", 1.0)])
def test_blender_sees_the_joints_within_a_millimetre_of_our_kinematics(
    suffix: str, scale: float, tmp_path: Path
) -> None:
    motion = tumbling()
    file = motion.save(tmp_path / f"tumbling{suffix}")
    found = blender("joints_of_file.py", file, str(scale), tmp_path / "joints.json")
    assert found["fps"] == pytest.approx(30.0)
    assert len(found["frames"]) == motion.frames
    for frame, joints in enumerate(found["frames"]):
        places = np.array([joints[name] for name in motion.skeleton.names])
        np.testing.assert_allclose(places, motion.positions()[frame], atol=1e-3)


@pytest.fixture(scope="module")
def used(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The add-on used once."""
    return with_addon("use_addon.py", tmp_path_factory.mktemp("addon") / "seen.json")


@pytest.fixture(scope="module")
def own_rig(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The add-on used on a rig with Mixamo's names."""
    return with_addon("use_own_rig.py", tmp_path_factory.mktemp("rig") / "seen.json")


def with_addon(script: str, out: Path) -> dict[str, Any]:
    """What a script does with the add-on and the packages of this Python."""
    if python_of_blender() != f"{sys.version_info.major}.{sys.version_info.minor}":
        pytest.skip(f"Blender has Python {python_of_blender()}, the tests another: their packages do not fit")
    packages = os.pathsep.join([str(Path(motionrt.__file__).parents[1]), str(Path(np.__file__).parents[1])])
    return blender(script, ADDON, out, env={"PYTHONPATH": packages})


def test_the_add_on_finds_what_the_runtime_finds(used: dict[str, Any]) -> None:
    hits = motionrt.Runtime().retrieve("a person walks in a circle", k=5)
    assert [clip for clip, _ in used["hits"]] == [hit.id for hit in hits]


def test_the_add_on_generates_the_runtimes_motion_within_a_millimetre(used: dict[str, Any]) -> None:
    motion = motionrt.Runtime().generate("a person waves with the right hand", seconds=2.0, seed=1)
    for frame, joints in enumerate(used["generated"]):
        places = np.array([joints[name] for name in motion.skeleton.names])[:, [0, 2, 1]] * [1, 1, -1]
        np.testing.assert_allclose(places, motion.positions()[frame], atol=1e-3)


def test_the_add_on_walks_on_from_the_pose_to_the_cursor(used: dict[str, Any]) -> None:
    pelvis = np.array([joints["pelvis"] for joints in used["walk"]])
    last = np.array(used["generated"][59]["pelvis"])
    np.testing.assert_allclose(pelvis[0], last, atol=1e-4)
    assert np.linalg.norm(np.diff(pelvis, axis=0), axis=1).max() < 0.08
    np.testing.assert_allclose(pelvis[-1][:2], [1.5, -4.0], atol=0.1)
    assert 0.8 < pelvis[-1][2] < 1.05


def test_the_add_on_names_the_action_after_the_clip(used: dict[str, Any]) -> None:
    assert used["applied"].startswith("a person")


def test_hits_are_previewed_on_a_figure_with_a_body_that_apply_takes_away(used: dict[str, Any]) -> None:
    bodies, vertices, action = used["previewed"]
    assert used["still_active"]
    assert bodies == 1
    assert vertices > 4000
    assert action.startswith("preview of a person")
    assert used["preview_gone"]


def test_keys_behind_the_current_frame_are_kept_in_the_action_that_they_are_in(used: dict[str, Any]) -> None:
    assert used["kept"] == [True, True, True]


def test_the_walk_along_a_curve_keeps_to_it(used: dict[str, Any]) -> None:
    pelvis = np.array(used["along"])[:, :2]
    corners = np.array([[1.0, 0.0], [1.0, -3.0], [3.0, -4.0]])
    line = np.concatenate([np.linspace(a, b, 200) for a, b in ((corners[0], corners[1]), corners[1:])])
    off = np.linalg.norm(pelvis[:, None] - line, axis=2).min(axis=1)
    assert off.max() < 0.4  # corners are cut
    np.testing.assert_allclose(pelvis[-1], corners[-1], atol=0.15)


def test_markers_become_one_motion_along_the_curve(used: dict[str, Any]) -> None:
    name, (first, last), pelvis = used["timeline"]
    assert name == "walk forward, a person walks forward"
    assert (first, last) == (11, 130)
    np.testing.assert_allclose(np.array(pelvis)[[0, 2], :2], [[1.0, 0.0], [3.0, -4.0]], atol=0.25)


def test_the_add_on_refuses_an_empty_text_with_the_runtimes_words(used: dict[str, Any]) -> None:
    assert "the text is empty" in used["refused"]


@pytest.mark.skipif(find_spec("bpy") is None, reason="needs Blender as a Python module: pip install bpy")
def test_the_add_on_does_the_same_in_bpy_from_pypi(used: dict[str, Any], tmp_path: Path) -> None:
    out = tmp_path / "seen.json"
    command = [sys.executable, str(SCRIPTS / "use_addon.py"), "--", str(ADDON), str(out)]
    subprocess.run(command, check=True, capture_output=True)
    found = json.loads(out.read_text(encoding="utf-8"))
    for name in ("hits", "applied", "previewed", "preview_gone", "kept"):
        assert found[name] == used[name]
    for name in ("generated", "walk", "along"):
        assert len(found[name]) == len(used[name])
    np.testing.assert_allclose(found["along"], used["along"], atol=0.02)


def test_on_an_artists_rig_limbs_point_as_those_of_the_runtimes_motion(own_rig: dict[str, Any]) -> None:
    motion = motionrt.Runtime().generate("a person walks forward", seconds=3.0, seed=1)
    pairs = {
        ("LeftUpLeg", "LeftLeg"): ("left_hip", "left_knee"),
        ("RightArm", "RightForeArm"): ("right_shoulder", "right_elbow"),
        ("LeftForeArm", "LeftHand"): ("left_elbow", "left_wrist"),
    }
    for (upper, lower), (start, end) in pairs.items():
        found = np.array([np.subtract(frame[lower], frame[upper]) for frame in own_rig["generated"]])
        wanted = motion.positions()[:, motion.skeleton.index(end)] - motion.positions()[:, motion.skeleton.index(start)]
        wanted = wanted[:, [0, 2, 1]] * [1, -1, 1]
        cosine = (found * wanted).sum(1) / np.linalg.norm(found, axis=1) / np.linalg.norm(wanted, axis=1)
        assert np.rad2deg(np.arccos(cosine.clip(-1, 1))).max() < (6 if upper == "LeftUpLeg" else 0.5)


def test_on_an_artists_rig_hips_and_feet_keep_their_heights(own_rig: dict[str, Any]) -> None:
    motion = motionrt.Runtime().generate("a person walks forward", seconds=3.0, seed=1)
    share = np.mean([frame["Hips"][2] for frame in own_rig["generated"]]) / own_rig["rest"]["Hips"][2]
    standing = -motion.skeleton.rest_positions[motion.skeleton.index("left_foot"), 1]
    assert share == pytest.approx(motion.root[:, 1].mean() / standing, abs=0.06)
    lowest = np.array([min(frame["LeftToeBase"][2], frame["RightToeBase"][2]) for frame in own_rig["generated"]])
    assert 0.0 < lowest.min() < 0.05
    assert np.percentile(lowest, 90) < 0.08


def test_on_an_artists_rig_the_walk_goes_on_to_the_cursor(own_rig: dict[str, Any]) -> None:
    hips = np.array([frame["Hips"] for frame in own_rig["walk"]])
    assert np.linalg.norm(np.diff(hips, axis=0), axis=1).max() < 0.08
    np.testing.assert_allclose(hips[-1][:2], [1.0, -6.0], atol=0.1)


def test_on_an_artists_rig_fingers_get_no_keys(own_rig: dict[str, Any]) -> None:
    assert "Hips" in own_rig["keyed"]
    assert "LeftHandIndex1" not in own_rig["keyed"]


def test_the_add_on_installs_a_package_into_the_users_folder(tmp_path: Path) -> None:
    archive = Path(shutil.make_archive(str(tmp_path / "addon"), "zip", ADDON, "motionrt_blender"))
    home = {name: str(tmp_path / "home") for name in ("HOME", "XDG_CONFIG_HOME")}
    found = blender("install_addon.py", archive, tiny_wheel(tmp_path), tmp_path / "out.json", env=home)
    assert Path(found["file"]).is_relative_to(tmp_path / "home")
    assert found["poll"]


def tiny_wheel(folder: Path) -> Path:
    """A package of the right name with nothing in it, so that nothing has to be downloaded."""
    path = folder / "motionrt-0.0.1-py3-none-any.whl"
    info = "motionrt-0.0.1.dist-info"
    with zipfile.ZipFile(path, "w") as wheel:
        wheel.writestr("motionrt/__init__.py", "")
        wheel.writestr(f"{info}/METADATA", "Metadata-Version: 2.1\nName: motionrt\nVersion: 0.0.1\n")
        wheel.writestr(
            f"{info}/WHEEL", "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        )
        wheel.writestr(f"{info}/RECORD", "")
    return path
