"""One door for all formats."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mini_files import AMC, ASF, BVH, write
from motions import random_motion, standing
from numpy.testing import assert_allclose

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError, RigError
from motionrt.formats import MOTION_SUFFIXES, load_motion, load_rig, save_motion, write_bvh
from motionrt.motion import Motion


def test_suffix_chooses_the_reader_in_any_case(tmp_path: Path) -> None:
    write(tmp_path / "01.asf", ASF)
    assert load_rig(write(tmp_path / "clip.BVH", BVH)).names[0] == "hip"
    assert load_rig(write(tmp_path / "01_01.Amc", AMC)).names[0] == "root"
    assert load_rig(standing().save(tmp_path / "clip.NPZ")).names[0] == "pelvis"
    assert load_rig(standing().save(tmp_path / "clip.Glb")).names[0] == "pelvis"
    assert {".bvh", ".amc", ".npz", ".npy", ".glb", ".gltf", ".vrm", ".vrma", ".fbx"} == set(MOTION_SUFFIXES)


def test_strings_and_names_with_spaces_and_other_letters_are_paths(tmp_path: Path) -> None:
    path = write(tmp_path / "mein Ordner" / "Läufer 走る.bvh", BVH)
    assert load_rig(str(path)).frames == 2


def test_fps_replaces_what_the_file_says(tmp_path: Path) -> None:
    path = standing(5, fps=30).save(tmp_path / "clip.npz")
    assert load_rig(path, fps=24).fps == 24
    assert load_motion(path, fps=24).fps == 24


@pytest.mark.parametrize("fps", [0, -1, float("nan"), float("inf")])
def test_fps_must_be_positive(tmp_path: Path, fps: float) -> None:
    with pytest.raises(InvalidInputError, match="fps must be a positive number"):
        load_rig(write(tmp_path / "clip.bvh", BVH), fps=fps)


def test_unknown_suffix_lists_the_known_ones(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"'.c3d' cannot be read; can be: .bvh, .amc, .npz"):
        load_motion(write(tmp_path / "clip.c3d", "x"))
    with pytest.raises(InvalidInputError, match=r"'.xyz' cannot be written; can be: .bvh, .glb"):
        save_motion(standing(), tmp_path / "clip.xyz")


def test_a_skeleton_alone_says_what_to_load(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"load the \.amc"):
        load_rig(write(tmp_path / "01.asf", ASF))


def test_missing_files_and_folders_are_told_apart(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"nothing\.bvh"):
        load_motion(tmp_path / "nothing.bvh")
    with pytest.raises(FileNotFoundError):
        load_motion(tmp_path / "nothing.bvh")
    (tmp_path / "folder.bvh").mkdir()
    with pytest.raises(FormatError, match="is a folder"):
        load_motion(tmp_path / "folder.bvh")


def test_a_rig_that_is_no_humanoid_is_a_rig_error(tmp_path: Path) -> None:
    with pytest.raises(RigError):
        load_motion(write(tmp_path / "chain.bvh", BVH))


def test_a_mistake_in_a_reader_is_not_said_to_be_one_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def mistaken(*_: object, **__: object) -> None:
        raise IndexError("list index out of range")

    monkeypatch.setattr("motionrt.formats.load.read_bvh", mistaken)
    with pytest.raises(IndexError):
        load_rig(write(tmp_path / "clip.bvh", BVH))


def with_leading_pose(tmp_path: Path) -> tuple[Motion, Path]:
    """A motion far from the T-pose, and a file of it with one more frame, the rest pose, in front."""
    motion = random_motion(30, fps=30, seed=2)
    bent = motion.rotations.copy()
    turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], np.float32)
    bent[:, 1:] = bent[:, 1:] @ turn
    motion = Motion(bent, motion.root, 30)
    rest = standing()
    both = Motion(np.concatenate([rest.rotations, bent]), np.concatenate([rest.root, motion.root]), 30)
    return motion, write_bvh(both, tmp_path / "clip.bvh")


def test_leading_pose_is_dropped_unless_asked_for(tmp_path: Path) -> None:
    motion, path = with_leading_pose(tmp_path)
    loaded = load_motion(path)
    assert loaded.frames == motion.frames
    assert_allclose(loaded.positions(), motion.positions(), atol=1e-3)
    whole = load_motion(path, keep_first_frame=True)
    assert whole.frames == motion.frames + 1
    assert_allclose(whole.positions()[1:], motion.positions(), atol=1e-3)
    assert_allclose(whole.rotations[0], standing().rotations[0], atol=1e-3)
    assert load_rig(path).frames == motion.frames + 1
