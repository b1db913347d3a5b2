"""Reading well-formed BVH files, in all the shapes that tools write."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from mini_files import BVH, bvh_of, write
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from motionrt.formats import read_bvh
from motionrt.rigs.clip import RigClip


def read(tmp_path: Path, text: str | bytes) -> RigClip:
    return read_bvh(write(tmp_path / "clip.bvh", text))


def test_reads_tree_offsets_and_rate(tmp_path: Path) -> None:
    clip = read(tmp_path, BVH)
    assert clip.names == ("hip", "chest", "hand", "hand_end")
    assert clip.parents == (-1, 0, 1, 2)
    assert_allclose(clip.offsets, [[0, 0, 0], [0, 10, 0], [5, 0, 0], [2, 0, 0]])
    assert (clip.frames, clip.fps, clip.up, clip.metres_per_unit) == (2, 30.0, None, None)
    assert clip.rotations.dtype == clip.translations.dtype == clip.offsets.dtype == np.float32


def test_positions_of_a_posed_frame_are_the_hand_worked_ones(tmp_path: Path) -> None:
    positions, _ = read(tmp_path, BVH).global_pose()
    # The hip turns 90 degrees about Z: +Y becomes -X, +X becomes +Y. The chest then turns by 90 about its own
    # Y, the world's -X: its +X goes to its -Z, the world's -Z. The hand's own X turn moves nothing.
    assert_allclose(positions[0], [[0, 0, 0], [0, 10, 0], [5, 10, 0], [7, 10, 0]], atol=1e-5)
    assert_allclose(positions[1], [[1, 2, 3], [-9, 2, 3], [-9, 2, -2], [-9, 2, -4]], atol=1e-5)


@pytest.mark.parametrize("order", ["".join(axes) for n in (1, 2, 3) for axes in permutations("XYZ", n)])
def test_any_order_and_number_of_rotation_channels_agrees_with_scipy(tmp_path: Path, order: str) -> None:
    angles = [31.0, -72.5, 118.25][: len(order)]
    channels = " ".join(f"{axis}rotation" for axis in order)
    clip = read(tmp_path, bvh_of(channels, " ".join(map(str, angles))))
    expected = Rotation.from_euler(order, angles, degrees=True).as_matrix().reshape(3, 3)
    assert_allclose(clip.rotations[0, 0], expected, atol=1e-6)


def test_repeated_axis_is_a_proper_euler_sequence(tmp_path: Path) -> None:
    clip = read(tmp_path, bvh_of("Zrotation Xrotation Zrotation", "20 30 40"))
    expected = Rotation.from_euler("ZXZ", [20, 30, 40], degrees=True).as_matrix()
    assert_allclose(clip.rotations[0, 0], expected, atol=1e-6)


def test_positions_behind_or_between_rotations_are_sorted_out(tmp_path: Path) -> None:
    channels = "Zrotation Yposition Xrotation Xposition Yrotation Zposition"
    clip = read(tmp_path, bvh_of(channels, "10 2 20 1 30 3"))
    expected = Rotation.from_euler("ZXY", [10, 20, 30], degrees=True).as_matrix()
    assert_allclose(clip.translations[0, 0], [1, 2, 3])
    assert_allclose(clip.rotations[0, 0], expected, atol=1e-6)


def test_position_channels_replace_the_offset_axis_by_axis(tmp_path: Path) -> None:
    clip = read(tmp_path, bvh_of("Yposition", "42", offset="7 8 9"))
    assert_allclose(clip.translations[0, 0], [7, 42, 9])
    assert_allclose(clip.offsets[0], [7, 8, 9])


def with_positions_everywhere(rows: str, chest_offset: str = "0 10 0") -> str:
    joint = "\t\tCHANNELS 3 Zrotation Xrotation Yrotation"
    text = BVH.replace(joint, joint.replace("3 ", "6 Xposition Yposition Zposition "), 1)
    text = text.replace("OFFSET 0 10 0", f"OFFSET {chest_offset}")
    return text[: text.index("0 0 0 0 0 0 0 0 0 0 0 0")] + rows


def test_position_channels_of_an_inner_joint_replace_its_offset(tmp_path: Path) -> None:
    rows = "0 0 0 0 0 0 0 11 1 0 0 0 0 0 0\n0 0 0 0 0 0 0 12 1 0 0 0 0 0 0\n"
    clip = read(tmp_path, with_positions_everywhere(rows))
    assert_allclose(clip.translations[:, 1], [[0, 11, 1], [0, 12, 1]])
    assert_allclose(clip.offsets[1], [0, 10, 0])


def test_position_channels_that_hold_differences_are_added_to_the_offset(tmp_path: Path) -> None:
    rows = "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0.5 0 0 0 0 0 0 0\n"
    clip = read(tmp_path, with_positions_everywhere(rows))
    assert_allclose(clip.translations[:, 1], [[0, 10, 0], [0, 10.5, 0]])


def test_a_joint_described_by_positions_alone_rests_where_it_mostly_is(tmp_path: Path) -> None:
    rows = "0 0 0 0 0 0 0 11 1 0 0 0 0 0 0\n0 0 0 0 0 0 0 11 1 0 0 0 0 0 0\n"
    clip = read(tmp_path, with_positions_everywhere(rows, chest_offset="0 0 0"))
    assert_allclose(clip.offsets[1], [0, 11, 1])


@pytest.mark.parametrize(
    "rewrite",
    [
        pytest.param(lambda t: t.replace("\n", "\r\n"), id="CRLF"),
        pytest.param(lambda t: t.replace("\n", "\r"), id="old Mac line ends"),
        pytest.param(lambda t: t.rstrip("\n"), id="no final newline"),
        pytest.param(lambda t: t + "\n \n\t\n", id="blank lines at the end"),
        pytest.param(lambda t: t.replace("\n", "\n\n"), id="blank lines everywhere"),
        pytest.param(lambda t: t.replace(" ", "\t"), id="tabs"),
        pytest.param(lambda t: t.replace("\t", "    "), id="spaces"),
        pytest.param(lambda t: t.replace(" 90 ", " 9.0E+01 ").replace("10 0", "1e1 0"), id="exponents"),
        pytest.param(lambda t: t.replace("0 10 0", "+0. 10. -0.0"), id="signs and bare points"),
        pytest.param(lambda t: t.lower(), id="lower case"),
        pytest.param(lambda t: t.replace("\n{", " {"), id="brace behind the name"),
        pytest.param(lambda t: t.replace("Frames: ", "Frames:").replace("Time: ", "Time:\t"), id="colons"),
        pytest.param(lambda t: t.replace("1 2 3 90 0 0 ", "1 2 3\n90 0\n0 "), id="frame over several lines"),
        pytest.param(lambda t: t.replace("0 0\n1 2 3", "0 0 1 2 3"), id="all frames on one line"),
        pytest.param(lambda t: "\ufeff" + t, id="byte order mark"),
        pytest.param(lambda t: "\n\n" + t, id="leading blank lines"),
    ],
)
def test_the_same_clip_in_another_spelling_reads_the_same(tmp_path: Path, rewrite: object) -> None:
    changed = rewrite(BVH)  # type: ignore[operator]
    assert changed != BVH
    expected, clip = read(tmp_path, BVH), read(tmp_path, changed)
    assert clip.names == expected.names
    assert clip.fps == expected.fps
    assert_allclose(clip.rotations, expected.rotations)
    assert_allclose(clip.translations, expected.translations)


@pytest.mark.parametrize("name", ["Bip01 L Thigh", "mixamorig:Hips", "Hüfte", "腰", "a.b|c#1", "MOTION 1"])
def test_names_may_hold_spaces_colons_and_any_letters(tmp_path: Path, name: str) -> None:
    assert read(tmp_path, BVH.replace("JOINT chest", f"JOINT {name}")).names[1] == name


def test_latin_1_names_are_read_where_the_file_is_not_utf_8(tmp_path: Path) -> None:
    text = BVH.replace("chest", "Hüfte").encode("latin-1")
    assert read(tmp_path, text).names[1] == "Hüfte"


def test_second_joint_of_a_name_is_numbered(tmp_path: Path) -> None:
    clip = read(tmp_path, BVH.replace("JOINT chest", "JOINT bone").replace("JOINT hand", "JOINT bone"))
    assert clip.names == ("hip", "bone", "bone_2", "bone_2_end")


def test_several_end_sites_of_one_joint_are_all_kept(tmp_path: Path) -> None:
    site = "\t\t\tEnd Site\n\t\t\t{\n\t\t\t\tOFFSET 2 0 0\n\t\t\t}\n"
    clip = read(tmp_path, BVH.replace(site, site + site.replace("2 0 0", "0 3 0")))
    assert clip.names[-2:] == ("hand_end", "hand_end_2")
    assert clip.parents[-2:] == (2, 2)
    assert_allclose(clip.offsets[-2:], [[2, 0, 0], [0, 3, 0]])


def test_joints_without_channels_stay_at_rest(tmp_path: Path) -> None:
    text = BVH.replace("\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\tJOINT", "\t\tJOINT")
    text = text.replace("0 0 0 0 0 0 0 0 0 0 0 0", "0 " * 9).replace("90 0 0 0 0 90 0 90 0", "90 0 0 0 90 0")
    clip = read(tmp_path, text)
    assert_allclose(clip.rotations[:, 1], np.broadcast_to(np.eye(3), (2, 3, 3)))


@pytest.mark.parametrize(
    ("written", "fps"),
    [("0.0166667", 60), ("0.016667", 60), ("0.00833333", 120), ("0.0333667", 1 / 0.0333667), ("1", 1)],
)
def test_frame_times_are_rates_freed_from_rounding(tmp_path: Path, written: str, fps: float) -> None:
    assert read(tmp_path, BVH.replace("0.033333", written)).fps == pytest.approx(fps, rel=1e-12)


def test_fps_replaces_a_nonsensical_frame_time(tmp_path: Path) -> None:
    path = write(tmp_path / "clip.bvh", BVH.replace("0.033333", "0"))
    assert read_bvh(path, fps=24).fps == 24


def test_a_still_pose_needs_no_frame_time(tmp_path: Path) -> None:
    assert read(tmp_path, bvh_of("Xrotation", "5").replace("0.01", "0")).fps == 30
