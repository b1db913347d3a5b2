"""Reading FBX: made files of known motions, in units and axes of several tools."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from fbx_files import write_fbx
from numpy.testing import assert_allclose
from retarget_rigs import Z_UP, person, rig

from motionrt.errors import FormatError, InvalidInputError, MissingDependencyError
from motionrt.formats import fbx, load_motion, load_rig, load_target
from motionrt.motion import SMPL24

NAMES = {name: f"mixamorig:{name}" for name in SMPL24.names}
needs_ufbx = pytest.mark.skipif(find_spec("ufbx") is None, reason='needs ufbx: pip install "motionrt[fbx]"')


@needs_ufbx
@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("centimetres", [1.0, 100.0])
def test_joints_are_where_they_were_whatever_unit_and_axes(tmp_path: Path, centimetres: float, up: str) -> None:
    truth = person(40)
    clip = rig(truth, NAMES, scale=100 / centimetres, world=Z_UP if up == "z" else None)
    path = write_fbx(clip, tmp_path / "walk.fbx", centimetres_per_unit=centimetres, up=up)
    found = load_rig(path)
    places = found.global_pose()[0][:, [found.names.index(NAMES[name]) for name in SMPL24.names]]
    assert found.fps == 30
    assert_allclose(places, truth.positions(), atol=1e-3)
    motion = load_motion(path)
    parents = list(SMPL24.parents[1:])
    one, two = motion.positions(), truth.positions()
    assert_allclose(one[:, 1:] - one[:, parents], two[:, 1:] - two[:, parents], atol=3e-3)


@needs_ufbx
def test_another_rate_samples_the_same_take(tmp_path: Path) -> None:
    path = write_fbx(rig(person(31), NAMES), tmp_path / "walk.fbx", centimetres_per_unit=100, up="y")
    assert load_rig(path, fps=60).frames == 61
    assert load_rig(path, animation="Take 001").frames == 31
    with pytest.raises(FormatError, match="no animation 'Run'; it has: Take 001"):
        load_rig(path, animation="Run")


@needs_ufbx
def test_an_fbx_character_takes_motions_as_glb_and_bvh(tmp_path: Path) -> None:
    still = rig(person(1), NAMES, scale=100)
    path = write_fbx(still, tmp_path / "hero.fbx", centimetres_per_unit=1, up="y")
    walk = person(20)
    for suffix in (".glb", ".bvh"):
        out = load_motion(walk.retarget_to(load_target(path)).save(tmp_path / f"out{suffix}"))
        parents = list(SMPL24.parents[1:22])
        one, two = out.positions()[:, :22], walk.positions()[:, :22]
        assert np.abs((one[:, 1:] - one[:, parents]) - (two[:, 1:] - two[:, parents])).max() < 0.02


@needs_ufbx
@pytest.mark.parametrize("content", [b"", b"Kaydara FBX Binary  \x00\x1a\x00", b"HIERARCHY\nROOT a\n", b"\0" * 300])
def test_what_is_no_fbx_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "broken.fbx"
    path.write_bytes(content)
    with pytest.raises(FormatError, match=r"broken\.fbx"):
        load_rig(path)


def test_without_the_library_the_error_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "ufbx", None)
    path = tmp_path / "walk.fbx"
    path.write_bytes(b"Kaydara FBX Binary  \x00\x1a\x00")
    with pytest.raises(MissingDependencyError, match=r"motionrt\[fbx\].*\.glb or \.bvh"):
        fbx.read_fbx(path)


_AGAIN_AND_AGAIN = """
import gc, resource, sys
from motionrt.formats import animations_of, load_rig
for k in range(120):
    load_rig(sys.argv[1]) if k % 4 == 0 else animations_of(sys.argv[1])
    litter = [[k] for _ in range(997 * k % 2000)]
    gc.collect() if k % 5 == 0 else None
    if k == 40:
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


@needs_ufbx
@pytest.mark.skipif(sys.platform == "win32", reason="measures memory by the module resource")
def test_hundreds_of_files_are_read_without_a_crash_or_a_leak(tmp_path: Path) -> None:
    path = write_fbx(rig(person(10), NAMES), tmp_path / "walk.fbx", centimetres_per_unit=100, up="y")
    command = [sys.executable, "-c", _AGAIN_AND_AGAIN, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-500:]
    assert int(done.stdout) < 20_000  # kB


def test_without_blender_writing_says_what_it_needs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOTIONRT_BLENDER", str(tmp_path / "no such program"))
    with pytest.raises(MissingDependencyError, match="writing FBX needs Blender"):
        person(2).save(tmp_path / "walk.fbx")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="writes a shell script in place of Blender")
def test_a_blender_that_fails_is_quoted_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "bin" / "blender"
    program.parent.mkdir()
    program.write_text("#!/bin/sh\necho 'no importer here' >&2\nexit 1\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("MOTIONRT_BLENDER", str(program))
    with pytest.raises(InvalidInputError, match="no importer here"):
        person(2).save(tmp_path / "walk.fbx")
    assert [path.name for path in tmp_path.iterdir()] == ["bin"]
