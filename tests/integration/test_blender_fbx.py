"""FBX files by a real Blender: read where our joints are, whatever their unit and axes; and written through it."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from characters import character
from glb_files import glb
from test_blender import NO_BLENDER, blender, tumbling

from motionrt import load_motion, load_target
from motionrt.formats import load_rig
from motionrt.rigs.plain_kinematics import joint_transforms

pytest.importorskip("ufbx", reason='needs the extra fbx: pip install "motionrt[fbx]"')
pytestmark = pytest.mark.skipif(shutil.which("blender") is None, reason=NO_BLENDER)
FILES = {"centimetres_y": (1.0, 1), "centimetres_z": (1.0, 2), "metres_y": (100.0, 1), "metres_z": (100.0, 2)}


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """By unit and vertical axis: the file of the tumbling figure."""
    folder = tmp_path_factory.mktemp("fbx")
    return blender("export_fbx.py", tumbling().save(folder / "tumbling.glb"), folder / "written.json")


def setting(content: bytes, name: bytes, kind: str) -> float:
    """A global setting of a binary FBX: the number behind its name, kind, label and flags."""
    tail = content[content.index(name) :]
    code = {"<d": b"D", "<i": b"I"}[kind]
    return struct.unpack_from(kind, tail, tail.index(b"S\0\0\0\0" + code) + 6)[0]


@pytest.mark.parametrize("file", FILES)
def test_joints_of_blenders_fbx_are_within_a_millimetre_of_ours(exported: dict[str, str], file: str) -> None:
    unit, up = FILES[file]
    content = Path(exported[file]).read_bytes()
    assert content.startswith(b"Kaydara FBX Binary")
    assert (setting(content, b"UnitScaleFactor", "<d"), setting(content, b"UpAxis", "<i")) == (unit, up)
    motion = tumbling()
    clip = load_rig(exported[file])
    assert (clip.fps, clip.frames) == (pytest.approx(30.0), motion.frames)
    places = joint_transforms(clip)[..., :3, 3]
    order = [clip.names.index(name) for name in motion.skeleton.names]
    np.testing.assert_allclose(places[:, order], motion.positions(), atol=1e-3)
    np.testing.assert_allclose(load_motion(exported[file]).positions(), motion.positions(), atol=1e-3)


@pytest.mark.skipif(shutil.which("assimp") is None, reason="needs assimp: apt-get install assimp-utils")
@pytest.mark.parametrize("file", FILES)
def test_joints_of_a_text_fbx_by_assimp_are_within_a_millimetre(
    exported: dict[str, str], tmp_path: Path, file: str
) -> None:
    """assimp puts the keys a second apart and says that the take lasts one second: that is set right."""
    target, motion = tmp_path / "text.fbx", tumbling()
    subprocess.run(["assimp", "export", exported[file], str(target), "-ffbxa"], check=True, capture_output=True)
    text = target.read_text(encoding="utf-8")
    assert text.startswith("; FBX")
    last = str(46_186_158_000 * (motion.frames - 1))  # ticks
    target.write_text(re.sub(r'(Stop", "KTime", "Time", "",) \d+', rf"\1 {last}", text), encoding="utf-8")
    clip = load_rig(target, fps=1)
    order = [clip.names.index(name) for name in motion.skeleton.names]
    np.testing.assert_allclose(joint_transforms(clip)[..., :3, 3][:, order], motion.positions(), atol=1e-3)


@pytest.mark.parametrize("fps", [30.0, 23.976])
def test_a_motion_written_as_fbx_comes_back_within_a_millimetre(tmp_path: Path, fps: float) -> None:
    motion = type(tumbling())(tumbling().rotations, tumbling().root, fps)
    back = load_motion(motion.save(tmp_path / "a 'walk'.fbx"))
    assert (back.fps, back.frames) == (pytest.approx(fps), motion.frames)
    np.testing.assert_allclose(back.positions(), motion.positions(), atol=1e-3)


def test_a_motion_on_an_own_character_is_written_as_fbx(tmp_path: Path) -> None:
    target = load_target(glb(character("mixamo")).save(tmp_path / "hero.glb"))
    moved = tumbling().grounded().retarget_to(target)
    clip = load_rig(moved.save(tmp_path / "hero_moves.fbx"))
    places = joint_transforms(clip)[..., :3, 3]
    order = [clip.names.index(name) for name in moved.names]
    np.testing.assert_allclose(places[:, order], moved.positions(), atol=1e-3)
