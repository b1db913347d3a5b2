"""AMASS npz files in and out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from mini_files import write
from motions import random_motion
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats import load_motion, read_npz, write_npz
from motionrt.motion import SMPL24, Motion
from motionrt.motion.skeleton import Skeleton

FRAMES = 3


def amass(tmp_path: Path, width: int = 156, **changes: object) -> Path:
    rng = np.random.default_rng(width)
    content: dict[str, object] = {
        "poses": rng.normal(0, 0.5, (FRAMES, width)),
        "trans": rng.normal(0, 1, (FRAMES, 3)),
        "mocap_framerate": np.array(120.0),
        "gender": np.array("female"),
        "betas": np.zeros(16),
    }
    content.update(changes)
    path = tmp_path / "clip_poses.npz"
    np.savez(path, **{key: value for key, value in content.items() if value is not None})
    return path


def test_z_up_becomes_y_up(tmp_path: Path) -> None:
    upright = np.zeros((FRAMES, 156))
    upright[:, :3] = [np.pi / 2, 0, 0]  # the template stands along Y; AMASS turns it up to Z, facing -Y
    clip = read_npz(amass(tmp_path, poses=upright, trans=np.tile([1.0, 2.0, 0.9], (FRAMES, 1))))
    assert (clip.up, clip.metres_per_unit, clip.fps) == ("y", 1.0, 120.0)
    assert_allclose(clip.rotations[0, 0], np.eye(3), atol=1e-6)
    assert_allclose(clip.translations[0, 0], [1, 0.9, -2], atol=1e-6)
    positions, _ = clip.global_pose()
    assert positions[0, SMPL24.index("head"), 1] > 1.4
    assert positions[0, SMPL24.index("left_foot"), 2] > -2 + 0.05


@pytest.mark.parametrize("width", [66, 72, 156, 165])
def test_body_joints_come_first_in_every_model(tmp_path: Path, width: int) -> None:
    path = amass(tmp_path, width)
    with np.load(path) as archive:
        vectors = archive["poses"].reshape(FRAMES, -1, 3)
    clip = read_npz(path)
    assert clip.names == SMPL24.names
    expected = Rotation.from_rotvec(vectors[:, 1:22].reshape(-1, 3)).as_matrix().reshape(FRAMES, 21, 3, 3)
    assert_allclose(clip.rotations[:, 1:22], expected, atol=1e-6)


@pytest.mark.parametrize(("width", "left", "right"), [(72, 22, 23), (156, 25, 40), (165, 28, 43)])
def test_hands_follow_hand_or_middle_finger(tmp_path: Path, width: int, left: int, right: int) -> None:
    poses = np.zeros((FRAMES, width // 3, 3))
    poses[:, left], poses[:, right] = [0.1, 0.2, 0.3], [0.4, 0.5, 0.6]
    clip = read_npz(amass(tmp_path, width, poses=poses.reshape(FRAMES, width)))
    expected = Rotation.from_rotvec([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]).as_matrix()
    assert_allclose(clip.rotations[0, 22:], expected, atol=1e-6)


def test_hands_are_straight_where_the_file_has_none(tmp_path: Path) -> None:
    assert_allclose(read_npz(amass(tmp_path, 66)).rotations[0, 22:], np.tile(np.eye(3), (2, 1, 1)))


@pytest.mark.parametrize("key", ["mocap_framerate", "mocap_frame_rate", "fps"])
def test_every_name_of_the_frame_rate_is_known(tmp_path: Path, key: str) -> None:
    rate = {"mocap_framerate": None, key: np.array([59.94])}
    assert read_npz(amass(tmp_path, **rate)).fps == pytest.approx(59.94)


def test_pose_in_parts_is_the_same_pose(tmp_path: Path) -> None:
    whole = read_npz(amass(tmp_path, 66))
    with np.load(tmp_path / "clip_poses.npz") as archive:
        poses = archive["poses"]
    parts = read_npz(amass(tmp_path, 66, poses=None, root_orient=poses[:, :3], pose_body=poses[:, 3:]))
    assert_array_equal(parts.rotations, whole.rotations)


def test_written_layout_is_that_of_amass(tmp_path: Path) -> None:
    motion = random_motion(5, fps=30)
    with np.load(write_npz(motion, tmp_path / "clip.npz")) as archive:
        assert archive["poses"].shape == (5, 156)
        assert archive["poses"].dtype == archive["trans"].dtype == np.float64
        assert_allclose(archive["trans"], motion.root[:, [0, 2, 1]] * [1, -1, 1], atol=1e-7)
        assert archive["mocap_framerate"] == 30
        assert_array_equal(archive["betas"], np.zeros(16))
        assert str(archive["gender"]) == "neutral"
        up = Rotation.from_rotvec(archive["poses"][:, :3]).as_matrix() @ [0, 1, 0]
        assert_allclose(up, (motion.rotations[:, 0] @ [0, 1, 0])[:, [0, 2, 1]] * [1, -1, 1], atol=1e-6)
        body = Rotation.from_rotvec(archive["poses"][:, 3:66].reshape(-1, 3)).as_matrix()
        assert_allclose(body.reshape(5, 21, 3, 3), motion.rotations[:, 1:22], atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(
    arrays(np.float64, (2, 24, 3), elements=st.floats(-4, 4, width=32)),
    arrays(np.float32, (2, 3), elements=st.floats(-100, 100, width=32)),
)
def test_any_motion_round_trips_to_1e_5(
    tmp_path_factory: pytest.TempPathFactory, vectors: np.ndarray, root: np.ndarray
) -> None:
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(2, 24, 3, 3)
    motion = Motion(matrices.astype(np.float32), root, 20.0)
    clip = read_npz(write_npz(motion, tmp_path_factory.mktemp("npz") / "clip.npz"))
    assert_allclose(clip.rotations, motion.rotations, atol=1e-5)
    assert_array_equal(clip.translations[:, 0], motion.root)


def test_written_motion_loads_as_the_same_motion(tmp_path: Path) -> None:
    motion = random_motion(20, fps=60, seed=5)
    loaded = load_motion(motion.save(tmp_path / "clip.npz"))
    assert loaded.fps == 60
    assert_allclose(loaded.rotations, motion.rotations, atol=1e-5)
    assert_allclose(loaded.root, motion.root, atol=1e-5)


def test_another_skeleton_cannot_be_written(tmp_path: Path) -> None:
    stick = Skeleton(("base",), (-1,), np.zeros((1, 3), np.float32))
    motion = Motion(np.tile(np.eye(3), (1, 1, 1, 1)), np.zeros((1, 3)), 30, stick)
    with pytest.raises(InvalidInputError, match="write this skeleton as BVH"):
        write_npz(motion, tmp_path / "clip.npz")


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"poses": None}, r"no 'poses', .*\(it holds betas, gender, mocap_framerate, trans\)"),
        ({"mocap_framerate": None}, "no frame rate .*give fps="),
        ({"mocap_framerate": np.array(0.0)}, "no frame rate between 1 and 1000"),
        ({"mocap_framerate": np.array([30.0, 60.0])}, "no frame rate between"),
        ({"mocap_framerate": np.array("fast")}, "no frame rate between 1 and 1000"),
        ({"poses": np.zeros((3, 100))}, r"'poses' has the shape \(3, 100\), expected \(frames, 66 | 72"),
        ({"poses": np.zeros(156)}, r"'poses' has the shape \(156,\)"),
        ({"poses": np.zeros((0, 156)), "trans": np.zeros((0, 3))}, "no frames"),
        ({"poses": np.full((3, 156), np.nan)}, "not finite or too large, first in frame 0"),
        ({"trans": np.array([[0, 0, 0], [0, np.inf, 0], [0, 0, 0]])}, "'trans' .* first in frame 1"),
        ({"trans": np.zeros((2, 3))}, r"'trans' has the shape \(2, 3\), expected \(3, 3\)"),
        ({"poses": np.zeros((3, 156), complex)}, "does not hold numbers but complex128"),
        ({"poses": np.array([{"a": 1}], dtype=object)}, "pickled objects, which are never loaded"),
        ({"poses": None, "root_orient": np.zeros((3, 3)), "pose_body": np.zeros((2, 63))}, "do not fit"),
    ],
)
def test_bad_content_is_named(tmp_path: Path, changes: dict[str, object], reason: str) -> None:
    with pytest.raises(FormatError, match=reason) as caught:
        read_npz(amass(tmp_path, **changes))
    assert caught.value.line is None


def test_bytes_that_are_no_archive_are_refused(tmp_path: Path) -> None:
    whole = amass(tmp_path).read_bytes()
    for content in (b"", b"not a zip", whole[: len(whole) // 2], b"PK\3\4 garbage"):
        with pytest.raises(FormatError, match="archive"):
            read_npz(write(tmp_path / "broken.npz", content))


def test_a_single_array_is_no_archive(tmp_path: Path) -> None:
    with (tmp_path / "array.npz").open("wb") as file:
        np.save(file, np.zeros((3, 156)))
    with pytest.raises(FormatError, match="a single NumPy array"):
        read_npz(tmp_path / "array.npz")


def test_missing_file_is_not_found(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError):
        read_npz(tmp_path / "nothing.npz")
