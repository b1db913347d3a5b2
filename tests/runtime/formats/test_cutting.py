"""A part of a file is that part of its motion, number for number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from motions import random_motion

from motionrt import load_motion
from motionrt.errors import FormatError
from motionrt.formats.cutting import can_cut, cut_file


@pytest.mark.parametrize("suffix", [".bvh", ".npz"])
@pytest.mark.parametrize("t_pose", [False, True])
def test_a_cut_file_holds_those_frames(tmp_path: Path, suffix: str, t_pose: bool) -> None:
    source = random_motion(50).save(tmp_path / f"whole{suffix}", t_pose=t_pose and suffix == ".bvh")
    whole = load_motion(source)
    assert whole.frames == 50
    part = load_motion(cut_file(source, tmp_path / f"part{suffix}", 10, 35, frames=50, fps=whole.fps))
    assert part.fps == whole.fps
    np.testing.assert_array_equal(part.root, whole.root[10:35])
    np.testing.assert_allclose(part.rotations, whole.rotations[10:35], atol=1e-6)


def test_the_lines_of_a_bvh_stay_as_they_are(tmp_path: Path) -> None:
    source = random_motion(20).save(tmp_path / "whole.bvh")
    cut_file(source, tmp_path / "part.bvh", 5, 8, frames=20, fps=30)
    whole, part = (path.read_text().splitlines() for path in (source, tmp_path / "part.bvh"))
    assert part[-3:] == whole[-15:-12]
    assert part[: part.index("MOTION")] == whole[: whole.index("MOTION")]


def test_an_amc_takes_its_skeleton_and_rate_along(tmp_path: Path) -> None:
    lines = ["#!comment", ":FULLY-SPECIFIED", ":DEGREES"]
    for frame in range(1, 7):
        lines += [str(frame), f"root 0 {frame} 0 0 0 0", f"lfemur {frame} 0 0"]
    source = tmp_path / "7_1.amc"
    source.write_text("\n".join(lines) + "\n")
    skeleton = tmp_path / "7.asf"
    skeleton.write_text(
        ":version 1.10\n:name made\n:units\nmass 1.0\nlength 0.45\nangle deg\n:root\norder TX TY TZ RX RY RZ\n"
        "axis XYZ\nposition 0 0 0\norientation 0 0 0\n:bonedata\nbegin\nid 1\nname lfemur\ndirection 0 -1 0\nlength 7\n"
        "axis 0 0 0 XYZ\ndof rx ry rz\nlimits (-180 180)\n(-180 180)\n(-180 180)\nend\n"
        ":hierarchy\nbegin\nroot lfemur\nend\n"
    )
    out = cut_file(source, tmp_path / "hits_1.amc", 2, 4, frames=6, fps=60)
    assert out.read_text().splitlines() == [
        "#!comment", ":FULLY-SPECIFIED", ":DEGREES", ":SAMPLES-PER-SECOND 60",
        "1", "root 0 3 0 0 0 0", "lfemur 3 0 0", "2", "root 0 4 0 0 0 0", "lfemur 4 0 0",
    ]  # fmt: skip
    assert (tmp_path / "hits_1.asf").read_text() == skeleton.read_text()


def test_a_file_that_became_shorter_is_refused(tmp_path: Path) -> None:
    source = random_motion(20).save(tmp_path / "whole.bvh")
    with pytest.raises(FormatError, match="20 frames now"):
        cut_file(source, tmp_path / "part.bvh", 5, 8, frames=40, fps=30)


def test_only_some_kinds_can_be_cut(tmp_path: Path) -> None:
    assert not can_cut(tmp_path / "x.glb")
    with pytest.raises(FormatError, match=r"\.bvh"):
        cut_file(tmp_path / "x.glb", tmp_path / "y.glb", 0, 1, frames=2, fps=30)
