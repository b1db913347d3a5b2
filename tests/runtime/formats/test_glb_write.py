"""Writing GLB: what other programs find in the file."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_files import Player, unpack
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from motions import random_motion, standing, walking
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.formats import load_motion, load_rig, write_glb
from motionrt.motion import SMPL24, Motion
from motionrt.motion.skeleton import Skeleton


def test_the_file_is_a_whole_container_of_aligned_chunks(tmp_path: Path) -> None:
    content = write_glb(walking(), tmp_path / "walk.glb").read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert size % 4 == 0
    assert kind == b"JSON"
    binary, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert 28 + size + binary == length
    assert binary % 4 == 0
    assert kind == b"BIN\0"
    document = json.loads(content[20 : 20 + size])
    assert document["asset"] == {"version": "2.0", "generator": "motionrt"}
    assert document["buffers"] == [{"byteLength": binary}]


def test_played_by_another_program_every_joint_is_where_it_should_be(tmp_path: Path) -> None:
    motion = random_motion(12, fps=30, seed=4)
    places = Player(write_glb(motion, tmp_path / "clip.glb")).places(list(SMPL24.names))
    assert_allclose(places, motion.positions(), atol=2e-6)


@pytest.mark.parametrize("fps", [20, 23.976, 24, 29.97, 30, 60, 120])
def test_keys_stand_at_the_times_of_the_frames(tmp_path: Path, fps: float) -> None:
    player = Player(write_glb(walking(50, fps), tmp_path / "clip.glb"))
    assert_allclose(player.times, np.arange(50) / fps, atol=1e-6)
    assert load_rig(tmp_path / "clip.glb").fps == pytest.approx(fps, rel=1e-5)


def test_quaternions_never_change_their_sign_between_frames(tmp_path: Path) -> None:
    turns = Rotation.from_euler("y", np.linspace(0, 1500, 151)[:, None], degrees=True).as_matrix()
    rotations = standing(151).rotations.copy()
    rotations[:, 0] = turns
    player = Player(write_glb(Motion(rotations, standing(151).root, 30), tmp_path / "spin.glb"))
    for (_, path), keys in player.tracks.items():
        if path == "rotation":
            assert (np.einsum("fi,fi->f", keys[1:], keys[:-1]) > 0).all()
            assert_allclose(np.linalg.norm(keys, axis=1), 1, atol=1e-6)


def test_the_bind_pose_is_the_t_pose_standing_on_the_floor(tmp_path: Path) -> None:
    player = Player(write_glb(walking(), tmp_path / "walk.glb"))
    skin = player.document["skins"][0]
    binds = np.linalg.inv(np.swapaxes(player.numbers(skin["inverseBindMatrices"]).reshape(-1, 4, 4), 1, 2))
    rest = SMPL24.rest_positions - [0, SMPL24.rest_positions[:, 1].min(), 0]
    assert_allclose(binds[:, :3, 3], rest, atol=1e-6)
    player.tracks.clear()
    assert_allclose([player.matrices(0)[name][:3, 3] for name in SMPL24.names], rest, atol=1e-6)
    assert [player.nodes[joint]["name"] for joint in skin["joints"]] == list(SMPL24.names)


def test_every_bone_has_a_body_that_follows_one_joint(tmp_path: Path) -> None:
    player = Player(write_glb(walking(), tmp_path / "walk.glb"))
    (primitive,) = player.document["meshes"][0]["primitives"]
    corners = player.numbers(primitive["attributes"]["POSITION"]).reshape(-1, 3, 3)
    normals = player.numbers(primitive["attributes"]["NORMAL"]).reshape(-1, 3, 3)
    weights = player.numbers(primitive["attributes"]["WEIGHTS_0"])
    assert len(corners) == 8 * (23 + 5)  # bones between joints, and crown, toes and fingers
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("tj,tcj->tc", outward, normals) > 0).all()
    bones = corners.reshape(-1, 8 * 3, 3)
    faces = corners.reshape(-1, 8, 3, 3).mean(axis=2) - bones.mean(axis=1)[:, None]
    assert (np.einsum("bfj,bfj->bf", faces, outward.reshape(-1, 8, 3)) > 0).all()  # seen from outside
    assert_allclose(weights, np.tile([1, 0, 0, 0], (len(weights), 1)))
    assert corners[..., 1].min() > -0.05
    assert 1.5 < np.ptp(corners[..., 1]) < 2


@settings(max_examples=25, deadline=None)
@given(arrays(np.float64, (3, 24, 3), elements=st.floats(-4, 4, width=32)), st.sampled_from([15.0, 20, 25, 30, 100]))
def test_any_motion_comes_back(tmp_path_factory: pytest.TempPathFactory, vectors: np.ndarray, fps: float) -> None:
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(3, 24, 3, 3)
    motion = Motion(matrices.astype(np.float32), vectors[:, 0].astype(np.float32), fps)
    loaded = load_motion(motion.save(tmp_path_factory.mktemp("glb") / "clip.glb"))
    assert loaded.fps == pytest.approx(fps)
    assert_allclose(loaded.positions(), motion.positions(), atol=1e-5)
    assert_allclose(loaded.rotations, motion.rotations, atol=1e-5)


@pytest.mark.parametrize("frames", [1, 2, 300])
def test_long_and_short_motions_come_back(tmp_path: Path, frames: int) -> None:
    motion = random_motion(frames, fps=30, seed=1)
    loaded = load_motion(motion.save(tmp_path / "clip.glb"))
    assert loaded.frames == frames
    assert_allclose(loaded.positions(), motion.positions(), atol=1e-4)


def test_other_skeletons_keep_their_names_and_bones(tmp_path: Path) -> None:
    skeleton = Skeleton(("base", "arm", "ärm tip"), (-1, 0, 1), np.array([[0, 0, 0], [0, 1, 0], [0, 1, 0]], np.float32))
    rotations = np.tile(np.eye(3, dtype=np.float32), (4, 3, 1, 1))
    motion = Motion(rotations, np.zeros((4, 3), np.float32), 30, skeleton)
    clip = load_rig(motion.save(tmp_path / "arm.glb"))
    assert clip.names == skeleton.names
    assert_allclose(clip.global_pose()[0], motion.positions(), atol=1e-6)


def test_a_single_joint_is_still_something_to_see(tmp_path: Path) -> None:
    point = Skeleton(("point",), (-1,), np.zeros((1, 3), np.float32))
    motion = Motion(np.eye(3, dtype=np.float32)[None, None], np.zeros((1, 3), np.float32), 30, point)
    document, _ = unpack(write_glb(motion, tmp_path / "point.glb").read_bytes())
    accessor = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    assert accessor["count"] == 24
    assert accessor["max"][1] > accessor["min"][1]


def test_the_animation_has_the_name_of_the_file_and_every_joint(tmp_path: Path) -> None:
    document, _ = unpack(write_glb(walking(), tmp_path / "läuft.glb").read_bytes())
    (animation,) = document["animations"]
    assert animation["name"] == "läuft"
    paths = [channel["target"]["path"] for channel in animation["channels"]]
    assert (paths.count("rotation"), paths.count("translation")) == (24, 1)
    assert document["scenes"][0]["nodes"] == [0, 24]


def test_options_of_bvh_are_refused(tmp_path: Path) -> None:
    for options in ({"units": "cm"}, {"t_pose": True}):
        with pytest.raises(InvalidInputError, match=r"are for a \.bvh"):
            standing().save(tmp_path / "clip.glb", **options)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="cannot write"):
        standing().save(tmp_path / "none" / "clip.glb")


def test_same_motion_same_bytes(tmp_path: Path) -> None:
    motion = random_motion(5, seed=2)
    first, second = (write_glb(replace(motion), tmp_path / name / "a.glb") for name in _folders(tmp_path))
    assert first.read_bytes() == second.read_bytes()


def _folders(path: Path) -> list[str]:
    for name in ("one", "two"):
        (path / name).mkdir()
    return ["one", "two"]


def test_joints_that_never_turn_take_one_key_and_the_motion_keeps_its_length(tmp_path: Path) -> None:
    still, moving = standing(200, 30), random_motion(200, 30)
    sizes = [write_glb(motion, tmp_path / f"{i}.glb").stat().st_size for i, motion in enumerate((still, moving))]
    assert sizes[0] < sizes[1] / 1.5
    assert load_motion(tmp_path / "0.glb").frames == 200
    assert len(Player(tmp_path / "0.glb").tracks[3, "rotation"]) == 1
