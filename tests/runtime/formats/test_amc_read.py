"""Reading ASF/AMC pairs: poses worked out by hand, Euler conventions against SciPy, and damage."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mini_files import AMC, ASF, write
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt.formats import read_amc, read_asf
from motionrt.rigs.clip import RigClip


def read(tmp_path: Path, amc: str = AMC, asf: str = ASF) -> RigClip:
    write(tmp_path / "01.asf", asf)
    return read_amc(write(tmp_path / "01_02.amc", amc))


def test_joints_are_named_by_the_bone_that_starts_at_them(tmp_path: Path) -> None:
    clip = read(tmp_path)
    assert clip.names == ("root", "lhipjoint", "lfemur", "ltibia", "ltibia_end")
    assert clip.parents == (-1, 0, 1, 2, 3)
    assert_allclose(clip.offsets, [[0, 0, 0], [0, 0, 0], [2, 0, 0], [0, -8, 0], [0, -7, 0]], atol=1e-6)
    assert clip.up == "y"
    assert clip.metres_per_unit == pytest.approx(0.0254 / 0.45)


def test_positions_are_the_hand_worked_ones(tmp_path: Path) -> None:
    positions, _ = read(tmp_path).global_pose()
    assert_allclose(positions[0], [[0, 15, 0], [0, 15, 0], [2, 15, 0], [2, 7, 0], [2, 0, 0]], atol=1e-5)
    # The root turns 90 degrees about Y: the hip lies to its +X, now the world's -Z. The thigh swings by -90
    # about X, from down to forward, the world's +X. The shin turns by 90 about its own X axis, which
    # C = Ry(90) puts along -Z: from down to -X, which the thigh's turn keeps and the root's makes +Z.
    assert_allclose(positions[1], [[1, 15, 2], [1, 15, 2], [1, 15, 0], [9, 15, 0], [9, 15, 7]], atol=1e-5)


@pytest.mark.parametrize("dof", ["rx ry rz", "rz ry rx", "ry rx rz", "rz rx", "ry"])
def test_channels_turn_about_fixed_axes_in_the_order_listed(tmp_path: Path, dof: str) -> None:
    angles = [20.0, -35.0, 50.0][: len(dof.split())]
    values = " ".join(map(str, angles))
    asf = ASF.replace("axis 0 0 0 XYZ\n     dof rx ry rz", f"axis 10 20 30 XYZ\n     dof {dof}")
    amc = AMC.replace("lfemur 0 0 0", f"lfemur {values}").replace("lfemur -90 0 0", f"lfemur {values}")
    frame = Rotation.from_euler("xyz", [10, 20, 30], degrees=True)
    turn = Rotation.from_euler(dof.replace("r", "").replace(" ", ""), angles, degrees=True)
    expected = (frame * turn * frame.inv()).as_matrix().reshape(3, 3)
    assert_allclose(read(tmp_path, amc, asf).rotations[0, 2], expected, atol=1e-6)


def test_axis_order_of_a_bone_is_respected(tmp_path: Path) -> None:
    asf = ASF.replace("axis 0 90 0 XYZ", "axis 30 90 45 ZXY")
    frame = Rotation.from_euler("zxy", [45, 30, 90], degrees=True)
    expected = (frame * Rotation.from_euler("x", 90, degrees=True) * frame.inv()).as_matrix()
    assert_allclose(read(tmp_path, asf=asf).rotations[1, 3], expected, atol=1e-6)


def test_radians_of_the_amc_are_read_as_such(tmp_path: Path) -> None:
    quarter = f"{np.pi / 2:.9f}"
    amc = AMC.replace("DEGREES", "RADIANS").replace("-90", f"-{quarter}").replace(" 90", f" {quarter}")
    assert_allclose(read(tmp_path, amc).rotations, read(tmp_path).rotations, atol=1e-6)


def test_radians_of_the_asf_apply_to_its_axes_and_are_the_default_of_the_amc(tmp_path: Path) -> None:
    quarter = f"{np.pi / 2:.9f}"
    expected = read(tmp_path).rotations
    asf = ASF.replace("angle deg", "angle rad").replace("axis 0 90 0", f"axis 0 {quarter} 0")
    amc = AMC.replace(":DEGREES\n", "").replace("-90", f"-{quarter}").replace(" 90", f" {quarter}")
    assert_allclose(read(tmp_path, amc, asf).rotations, expected, atol=1e-6)


def test_root_order_position_and_orientation_are_respected(tmp_path: Path) -> None:
    asf = ASF.replace("TX TY TZ RX RY RZ", "RZ RY RX TZ TY TX").replace("position 0 0 0", "position 5 6 7")
    amc = AMC.replace("1 15 2 0 90 0", "0 90 0 2 15 1").replace("0 15 0 0 0 0", "0 0 0 0 15 0")
    clip = read(tmp_path, amc, asf)
    assert_allclose(clip.translations[:, 0], [[5, 21, 7], [6, 21, 9]])
    assert_allclose(clip.rotations[:, 0], read(tmp_path).rotations[:, 0], atol=1e-6)


@pytest.mark.parametrize(
    "rewrite",
    [
        pytest.param(lambda t: t.replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lambda t: t.replace(" ", "\t") + "\n\n", id="tabs and blank lines"),
        pytest.param(lambda t: t.rstrip("\n"), id="no final newline"),
        pytest.param(lambda t: t.replace("2\nroot", "# half-way\n2\nroot"), id="comment between frames"),
        pytest.param(lambda t: t.replace("lfemur -90 0 0\nltibia 90", "ltibia 90\nlfemur -90 0 0"), id="order"),
        pytest.param(lambda t: t.replace("\n2\n", "\n8\n").replace("\n1\n", "\n7\n"), id="counted from 7"),
        pytest.param(lambda t: t.replace(":DEGREES", ":degrees"), id="lower case keyword"),
        pytest.param(lambda t: t.replace("-90 0 0", "-9.0e1 0. +0"), id="exponents"),
    ],
)
def test_the_same_motion_in_another_spelling_reads_the_same(tmp_path: Path, rewrite: object) -> None:
    changed = rewrite(AMC)  # type: ignore[operator]
    assert changed != AMC
    assert_allclose(read(tmp_path, changed).rotations, read(tmp_path).rotations)


def test_bones_that_the_motion_does_not_mention_stay_at_rest(tmp_path: Path) -> None:
    clip = read(tmp_path, AMC.replace("ltibia 90\n", "").replace("ltibia 0\n", ""))
    assert_allclose(clip.rotations[:, 3], np.broadcast_to(np.eye(3), (2, 3, 3)))


def test_unit_without_a_scale_is_unknown(tmp_path: Path) -> None:
    assert read(tmp_path, asf=ASF.replace("length 0.45", "length 1.0")).metres_per_unit is None


def line_of(text: str, fragment: str) -> int:
    return text[: text.index(fragment)].count("\n") + 1


@pytest.mark.parametrize(
    ("old", "new", "at", "reason"),
    [
        ("ltibia 90", "ltibia ninety", "ltibia 90", "expected a number, found 'ninety'"),
        ("ltibia 90", "ltibia nan", "ltibia 90", "not a finite number"),
        ("ltibia 90", "ltibia 90 5", "ltibia 90", "2 values instead of 1"),
        ("lfemur -90 0 0", "lfemur -90 0", "lfemur -90", "2 values instead of 3"),
        ("lfemur 0 0 0", "lfemur 0 0", "lfemur 0 0", "'lfemur' has 2 values, but 01.asf gives it 3 channels"),
        ("lfemur 0 0 0", "rfemur 0 0 0", "lfemur 0 0", "01.asf has no bone 'rfemur'"),
        ("lfemur -90", "rfemur -90", "lfemur -90", "'rfemur' is not in the first frame"),
        ("ltibia 90", "root 0 0 0 0 0 0", "ltibia 90", "'root' twice in one frame"),
        ("ltibia 0\n", "ltibia 0\nltibia 0\n", "2\nroot", "'ltibia' twice in one frame"),
        ("2\nroot", "4\nroot", "2\nroot", "frame 4 follows frame 1: frames are missing"),
        ("root 0 15 0 0 0 0\n", "", "1\nroot", "the first frame has no root"),
        (":DEGREES\n1\n", ":DEGREES\none\n", "1\nroot", "expected a frame number, found 'one'"),
    ],
)
def test_broken_motion_names_the_line(tmp_path: Path, old: str, new: str, at: str, reason: str) -> None:
    assert old in AMC
    with pytest.raises(FormatError) as caught:
        read(tmp_path, AMC.replace(old, new, 1))
    assert reason in caught.value.reason
    assert caught.value.line == line_of(AMC, at)
    assert caught.value.path.suffix == ".amc"


@pytest.mark.parametrize("cut", ["", "root 1 15", "root 1 15 2 0 90 0\nlfem", "root 1 15 2 0 90 0\nlfemur -90 0 0\n"])
def test_an_interrupted_export_keeps_its_whole_frames(tmp_path: Path, cut: str) -> None:
    clip = read(tmp_path, AMC[: AMC.index("\n2\n") + 3] + cut)
    assert clip.frames == 1
    assert "1 whole frames before it are read" in clip.notes[0]


def test_names_of_bones_are_known_however_their_letters_are_written(tmp_path: Path) -> None:
    found = read(tmp_path, AMC.replace("lfemur", "LFemur").replace("ltibia", "LTIBIA"))
    assert_allclose(found.rotations, read(tmp_path).rotations)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "empty"),
        ("<html>404</html>", "expected a frame number"),
        (":FULLY-SPECIFIED\n:DEGREES\n", "no frames"),
        ("a\0b", "binary"),
    ],
)
def test_files_that_are_no_amc_at_all(tmp_path: Path, content: str, reason: str) -> None:
    with pytest.raises(FormatError, match=reason):
        read(tmp_path, content)


@pytest.mark.parametrize(
    ("old", "new", "at", "reason"),
    [
        ("direction 1 0 0", "direction 1 0", "direction 1", "lacks a value"),
        ("direction 1 0 0", "direction 1 0 x", "direction 1", "expected a number, found 'x'"),
        ("length 8", "length inf", "length 8", "not a finite number"),
        ("dof rx ry rz", "dof rx rx rz", "dof rx ry", "no list of channels"),
        ("dof rx ry rz", "dof rx sy rz", "dof rx ry", "no list of channels"),
        ("axis 0 90 0 XYZ", "axis 0 90 0 XYY", "axis 0 90", "no order of axes"),
        ("name lfemur", "name lhipjoint", "begin\n     id 2", "one name of its own"),
        ("name lfemur", "name root", "begin\n     id 2", "one name of its own"),
        ("     name lfemur\n", "", "begin\n     id 2", "one name of its own"),
        ("length 0.45", "length 0", "length 0.45", "must be positive"),
        ("  end\n  begin\n     id 3", "  begin\n     id 3", "end\n  begin\n     id 3", "an 'end' is missing"),
        ("lhipjoint lfemur\n", "lhipjoint lfemr\n", "lhipjoint lfemur", "unknown bone 'lfemr'"),
        ("    lfemur ltibia\n", "", "begin\n     id 3", "bone 'ltibia' is not connected"),
        ("lfemur ltibia\n", "lfemur ltibia lhipjoint\n", "lfemur ltibia", "'lhipjoint' has two parents"),
        ("root lhipjoint\n", "ltibia lhipjoint\n", "begin\n     id 1", "'lhipjoint' is not connected"),
    ],
)
def test_broken_skeleton_names_the_line(tmp_path: Path, old: str, new: str, at: str, reason: str) -> None:
    assert old in ASF
    with pytest.raises(FormatError) as caught:
        read_asf(write(tmp_path / "broken.asf", ASF.replace(old, new, 1)))
    assert reason in caught.value.reason
    assert caught.value.line == line_of(ASF, at)


@pytest.mark.parametrize("section", [":root", ":bonedata", ":hierarchy"])
def test_skeleton_lacking_a_section_says_which(tmp_path: Path, section: str) -> None:
    with pytest.raises(FormatError, match=f"no {section} section"):
        read_asf(write(tmp_path / "broken.asf", ASF.replace(section, ":other")))


def test_missing_files_are_not_found(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"nothing\.amc"):
        read_amc(tmp_path / "nothing.amc")
    with pytest.raises(MotionFileNotFoundError, match=r"nothing\.asf"):
        read_amc(write(tmp_path / "a.amc", AMC), tmp_path / "nothing.asf")


@pytest.mark.parametrize(
    ("header", "fps"),
    [(":SAMPLES-PER-SECOND 30\n", 30.0), (":samples-per-second 25\n", 25.0), (":FPS 60\n", 60.0), ("", 120.0)],
)
def test_the_rate_that_the_header_states_counts_before_the_usual_one(tmp_path: Path, header: str, fps: float) -> None:
    write(tmp_path / "01.asf", ASF)
    path = write(tmp_path / "01_02.amc", header + AMC)
    assert read_amc(path).fps == fps
    assert read_amc(path, fps=50).fps == 50


def test_a_rate_in_the_header_that_makes_no_sense_is_refused_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"01_02\.amc:1: .*frames per second"):
        read(tmp_path, ":SAMPLES-PER-SECOND 0\n" + AMC)
