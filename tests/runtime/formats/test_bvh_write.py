"""Writing BVH: what comes back, and how the file looks to other programs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from motions import random_motion, standing
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.formats import load_motion, read_bvh, write_bvh
from motionrt.motion import SMPL24, Motion
from motionrt.motion.skeleton import Skeleton


def in_smpl24_order(path: Path) -> np.ndarray:
    clip = read_bvh(path)
    return clip.rotations[:, [clip.names.index(name) for name in SMPL24.names]]


def test_file_holds_the_rotations_and_the_root_in_centimetres(tmp_path: Path) -> None:
    motion = random_motion(20, fps=30)
    path = write_bvh(motion, tmp_path / "clip.bvh")
    clip = read_bvh(path)
    assert clip.fps == 30
    assert_allclose(in_smpl24_order(path), motion.rotations, atol=2e-6)
    assert_allclose(clip.translations[:, 0], motion.root * 100, atol=1e-4)
    hip = clip.names.index("left_hip")
    assert_allclose(clip.offsets[hip], SMPL24.offsets[1] * 100, atol=1e-5)


def test_written_motion_loads_as_the_same_motion(tmp_path: Path) -> None:
    motion = random_motion(30, fps=60, seed=3)
    loaded = load_motion(motion.save(tmp_path / "clip.bvh"))
    assert loaded.fps == motion.fps
    assert_allclose(loaded.positions(), motion.positions(), atol=1e-4)
    assert_allclose(loaded.rotations, motion.rotations, atol=1e-3)


@settings(max_examples=40, deadline=None)
@given(arrays(np.float64, (2, 24, 3), elements=st.floats(-4, 4, width=32)), st.floats(1, 240))
def test_any_rotation_round_trips(tmp_path_factory: pytest.TempPathFactory, vectors: np.ndarray, fps: float) -> None:
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(2, 24, 3, 3)
    motion = Motion(matrices.astype(np.float32), np.zeros((2, 3), np.float32), fps)
    path = write_bvh(motion, tmp_path_factory.mktemp("bvh") / "clip.bvh")
    assert_allclose(in_smpl24_order(path), motion.rotations, atol=1e-3)  # float32 at gimbal lock leaves 5e-4
    assert read_bvh(path).fps == pytest.approx(fps, rel=1.1e-4)


def test_angles_do_not_jump_by_whole_turns_between_frames(tmp_path: Path) -> None:
    turns = Rotation.from_euler("y", np.linspace(0, 900, 91)[:, None], degrees=True).as_matrix()
    motion = standing(91)
    rotations = motion.rotations.copy()
    rotations[:, 0] = turns
    path = write_bvh(Motion(rotations, motion.root, 30), tmp_path / "spin.bvh")
    lines = path.read_text(encoding="utf-8").splitlines()[-91:]
    rows = np.array([line.split() for line in lines], dtype=float)
    assert_allclose(np.diff(rows[:, 5]), 10, atol=1e-3)


def test_every_last_bone_has_a_length(tmp_path: Path) -> None:
    clip = read_bvh(write_bvh(standing(), tmp_path / "clip.bvh"))
    ends = [j for j, name in enumerate(clip.names) if name.endswith("_end")]
    assert {clip.names[j] for j in ends} == {
        "head_end", "left_foot_end", "right_foot_end", "left_hand_end", "right_hand_end"
    }  # fmt: skip
    assert (np.linalg.norm(clip.offsets[ends], axis=-1) > 5).all()
    rest = clip.rest_positions()
    toe, crown = clip.names.index("left_foot_end"), clip.names.index("head_end")
    assert rest[toe, 2] > rest[clip.names.index("left_foot"), 2]
    assert rest[crown, 1] == rest[:, 1].max()


def test_file_is_plain_and_needs_no_knowledge_of_the_root_offset(tmp_path: Path) -> None:
    raw = write_bvh(random_motion(3, fps=20), tmp_path / "clip.bvh").read_bytes()
    assert b"\r" not in raw
    assert raw.endswith(b"\n")
    lines = raw.decode("ascii").split("\n")
    assert lines[:4] == ["HIERARCHY", "ROOT pelvis", "{", "\tOFFSET 0.000000 0.000000 0.000000"]
    assert lines[4] == "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    assert "Frames: 3" in lines
    assert "Frame Time: 0.0500000000" in lines
    assert b"-0.000000" not in raw


def test_scale_sets_the_unit(tmp_path: Path) -> None:
    motion = random_motion(2)
    clip = read_bvh(write_bvh(motion, tmp_path / "metres.bvh", scale=1))
    assert_allclose(clip.translations[:, 0], motion.root, atol=1e-6)


@pytest.mark.parametrize("scale", [0, -1, float("nan"), float("inf")])
def test_scale_must_be_positive(tmp_path: Path, scale: float) -> None:
    with pytest.raises(InvalidInputError, match="scale"):
        write_bvh(standing(), tmp_path / "clip.bvh", scale=scale)


def test_other_skeletons_can_be_written_too(tmp_path: Path) -> None:
    tail = Skeleton(("base", "tip"), (-1, 0), np.array([[0, 0, 0], [0, 0, -0.5]], np.float32))
    motion = Motion(np.tile(np.eye(3), (1, 2, 1, 1)), np.zeros((1, 3)), 30, tail)
    clip = read_bvh(write_bvh(motion, tmp_path / "tail.bvh"))
    assert clip.names == ("base", "tip", "tip_end")
    assert_allclose(clip.offsets[1:], [[0, 0, -50], [0, 0, -25]])


def test_a_folder_that_does_not_exist_is_a_clear_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"cannot write .*clip\.bvh"):
        write_bvh(standing(), tmp_path / "nowhere" / "clip.bvh")


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_a_failed_write_leaves_the_old_file_and_no_litter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    path = tmp_path / f"clip{suffix}"
    path.write_text("precious", encoding="utf-8")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(InvalidInputError, match="No space left"):
        standing().save(path)
    assert path.read_text(encoding="utf-8") == "precious"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(("units", "scale"), [("cm", 100), ("m", 1), ("mm", 1000), ("in", 1 / 0.0254)])
def test_a_file_can_be_in_any_unit(tmp_path: Path, units: str, scale: float) -> None:
    motion = random_motion(5, fps=30)
    clip = read_bvh(motion.save(tmp_path / "clip.bvh", units=units))
    assert_allclose(clip.translations[:, 0], motion.root * scale, atol=1e-5 * scale)
    assert_allclose(load_motion(tmp_path / "clip.bvh").positions(), motion.positions(), atol=1e-4)


def test_an_unknown_unit_lists_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="units must be one of m, cm, mm, in, not 'ft'"):
        standing().save(tmp_path / "clip.bvh", units="ft")


def test_the_file_may_begin_with_a_t_pose_that_readers_drop_again(tmp_path: Path) -> None:
    motion = random_motion(20, fps=30, root=(2, 0.9, -1))
    clip = read_bvh(motion.save(tmp_path / "clip.bvh", t_pose=True))
    assert clip.frames == 21
    assert_allclose(clip.rotations[0], np.broadcast_to(np.eye(3), clip.rotations[0].shape), atol=1e-6)
    toe = clip.names.index("left_foot")
    first = clip.global_pose()[0][0]
    assert_allclose(first[toe, 1], 0, atol=1e-3)
    assert_allclose(first[0, [0, 2]], motion.root[0, [0, 2]] * 100, atol=1e-3)
    loaded = load_motion(tmp_path / "clip.bvh")
    assert_allclose(loaded.positions(), motion.positions(), atol=1e-4)
    assert load_motion(tmp_path / "clip.bvh", keep_first_frame=True).frames == 21
