"""Rigs that no motion can be put on: a clear error, whatever is wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from characters import Character, bvh_text, character
from glb_files import glb
from motions import random_motion, standing, walking
from numpy.testing import assert_allclose

from motionrt.errors import FormatError, InvalidInputError, RigError
from motionrt.formats import load_rig
from motionrt.motion import Motion
from motionrt.motion.skeleton import Skeleton

WALK = walking(4, 30)


def bvh(tmp_path: Path, person: Character, **options: object) -> Path:
    path = tmp_path / "rig.bvh"
    path.write_text(bvh_text(person, **options), encoding="utf-8")  # type: ignore[arg-type]
    return path


def without(person: Character, *words: str) -> Character:
    """The character without the joints whose names hold one of ``words``, and all below them."""
    gone: set[int] = set()
    for joint, (name, parent) in enumerate(zip(person.names, person.parents, strict=True)):
        if any(word in name for word in words) or parent in gone:
            gone.add(joint)
    kept = [joint for joint in range(len(person.names)) if joint not in gone]
    place = {joint: i for i, joint in enumerate(kept)}
    return Character(
        [person.names[joint] for joint in kept],
        [place.get(person.parents[joint], -1) for joint in kept],
        person.places[kept],
        {role: place[joint] for role, joint in person.roles.items() if joint in place},
    )


def test_a_rig_without_legs(tmp_path: Path) -> None:
    legless = without(character("mixamo"), "UpLeg")
    for rig in (bvh(tmp_path, legless), glb(legless).save(tmp_path / "rig.glb")):
        with pytest.raises(RigError, match=r"left_hip|humanoid"):
            WALK.retarget_to(rig)


def test_a_rig_that_is_no_humanoid(tmp_path: Path) -> None:
    chain = Character([f"b{i}" for i in range(6)], [-1, 0, 1, 2, 3, 4], np.arange(18.0).reshape(6, 3), {})
    with pytest.raises(RigError, match="not recognised as a humanoid"):
        WALK.retarget_to(glb(chain).save(tmp_path / "rig.glb"))


def test_two_roots_in_a_bvh(tmp_path: Path) -> None:
    path = bvh(tmp_path, character("mixamo"))
    hierarchy, motion = path.read_text(encoding="utf-8").split("MOTION")
    path.write_text(f"{hierarchy}ROOT other\n{{\nOFFSET 0 0 0\nCHANNELS 0\n}}\nMOTION{motion}", encoding="utf-8")
    with pytest.raises(FormatError, match="a second ROOT"):
        WALK.retarget_to(path)


def test_joints_of_one_name_in_two_branches_ask_which(tmp_path: Path) -> None:
    person = character("mixamo")
    person.names[person.roles["right_knee"]] = person.names[person.roles["left_knee"]]
    for rig in (bvh(tmp_path, person), glb(person).save(tmp_path / "rig.glb")):
        moved = WALK.retarget_to(rig)  # told apart by structure
        assert f"{person.names[person.roles['left_knee']]}_2" in moved.names


@pytest.mark.parametrize("scale", [0.001, 100.0])
def test_scale_does_not_matter(tmp_path: Path, scale: float) -> None:
    person = character("mixamo")
    expected = WALK.retarget_to(glb(person).save(tmp_path / "rig.glb")).positions()
    big = WALK.retarget_to(glb(person, unit=1 / scale).save(tmp_path / "big.glb"))
    assert_allclose(big.positions() / scale, expected, atol=1e-4)
    armature = WALK.retarget_to(glb(person, armature=(np.eye(3), scale)).save(tmp_path / "scaled.glb"))
    own = [armature.names.index(name) for name in person.names]
    assert_allclose(armature.positions()[:, own], expected, atol=1e-4)


def test_a_mirrored_armature_is_refused(tmp_path: Path) -> None:
    out = glb(character("mixamo"), armature=(np.eye(3), 1.0))
    next(node for node in out.document["nodes"] if node["name"] == "Armature")["scale"] = [-1, 1, 1]
    with pytest.raises(FormatError, match="'Armature' is mirrored"):
        WALK.retarget_to(out.save(tmp_path / "rig.glb"))


def test_a_rig_that_is_never_in_a_known_pose(tmp_path: Path) -> None:
    person = character("mixamo", extras=False)
    for side in ("left", "right"):  # legs up in front, arms behind
        for part, place in (("knee", [0, 0.0, 0.46]), ("ankle", [0, 0.44, 0.46]), ("foot", [0, 0.6, 0.5])):
            joint = person.roles[f"{side}_{part}"]
            person.places[joint] = person.places[person.roles[f"{side}_hip"]] + place
    for rig in (bvh(tmp_path, person), glb(person).save(tmp_path / "rig.glb")):
        with pytest.raises(RigError, match=r"no known standing pose.*save it in its T-pose"):
            WALK.retarget_to(rig)


def test_bones_without_length(tmp_path: Path) -> None:
    person = character("mixamo", extras=False)
    for side in ("left", "right"):
        person.places[person.roles[f"{side}_knee"]] = person.places[person.roles[f"{side}_hip"]]
    with pytest.raises(RigError):
        WALK.retarget_to(glb(person, frames="world").save(tmp_path / "rig.glb"))
    nothing = Character(person.names, person.parents, np.zeros_like(person.places), person.roles)
    with pytest.raises(RigError):
        WALK.retarget_to(glb(nothing, frames="world").save(tmp_path / "rig.glb"))


def test_bones_without_length_elsewhere_do_no_harm(tmp_path: Path) -> None:
    person = character("mixamo")
    for role in ("neck", "left_collar", "spine1"):
        joint = person.roles[role]
        person.places[joint] = person.places[person.parents[joint]]
    moved = random_motion(5, 30).retarget_to(glb(person, frames="world").save(tmp_path / "rig.glb"))
    assert np.isfinite(moved.positions()).all()


def test_a_rig_that_cannot_travel(tmp_path: Path) -> None:
    path = bvh(tmp_path, character("mixamo"))
    text = path.read_text(encoding="utf-8").replace("6 Xposition Yposition Zposition", "3")
    hierarchy, row = text.rstrip("\n").rsplit("\n", 1)
    path.write_text("\n".join([hierarchy, " ".join(row.split()[3:]), ""]), encoding="utf-8")
    with pytest.raises(RigError, match="position channels: it cannot travel"):
        WALK.retarget_to(path)


def test_root_motion_needs_a_joint_to_carry_it(tmp_path: Path) -> None:
    rig = glb(character("mixamo")).save(tmp_path / "rig.glb")
    with pytest.raises(RigError, match="no joint above its pelvis"):
        WALK.retarget_to(rig, root_motion=True)
    rig = glb(character("unreal", root="root")).save(tmp_path / "rig.glb")
    with pytest.raises(RigError, match="no joint 'hips' above the pelvis can carry root motion; there are: root"):
        WALK.retarget_to(rig, root_motion="hips")


def test_mappings_are_checked(tmp_path: Path) -> None:
    rig = glb(character("mixamo")).save(tmp_path / "rig.glb")
    with pytest.raises(RigError, match="names 'hip', no joint of smpl24"):
        WALK.retarget_to(rig, mapping={"hip": "mixamorig:Hips"})
    with pytest.raises(RigError, match="the rig has no joint 'Hips'"):
        WALK.retarget_to(rig, mapping={"pelvis": "Hips"})


def test_only_characters_are_targets_and_only_two_formats_are_written(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"a rig '\.npz' cannot be a target; can be: \.bvh, \.fbx, \.glb"):
        WALK.retarget_to(WALK.save(tmp_path / "clip.npz"))
    moved = WALK.retarget_to(glb(character("mixamo")).save(tmp_path / "rig.glb"))
    for name, options, message in (
        ("out.npz", {}, r"cannot be written with a motion of a rig"),
        ("out.glb", {"units": "cm"}, r"are for a \.bvh"),
        ("out.bvh", {"units": "miles"}, "units must be one of"),
    ):
        with pytest.raises(InvalidInputError, match=message):
            moved.save(tmp_path / name, **options)  # type: ignore[arg-type]
    moved = WALK.retarget_to(bvh(tmp_path, character("mixamo")))
    for name, options, message in (
        ("out.npz", {}, r"cannot be written with a motion of a rig"),
        ("out.bvh", {"units": "cm"}, "keeps those of rig.bvh"),
        ("out.glb", {"t_pose": True}, r"t_pose is for \.bvh"),
    ):
        with pytest.raises(InvalidInputError, match=message):
            moved.save(tmp_path / name, **options)  # type: ignore[arg-type]


def test_only_smpl24_can_be_retargeted(tmp_path: Path) -> None:
    rig = glb(character("mixamo")).save(tmp_path / "rig.glb")
    point = Skeleton(("point",), (-1,), np.zeros((1, 3), np.float32))
    motion = Motion(np.eye(3, dtype=np.float32)[None, None], np.zeros((1, 3), np.float32), 30, point)
    with pytest.raises(InvalidInputError, match="only motions of the smpl24 skeleton"):
        motion.retarget_to(rig)


def test_what_motionrt_wrote_is_a_target_as_well(tmp_path: Path) -> None:
    motion = random_motion(10, 30)
    for name in ("own.glb", "own.bvh"):
        moved = motion.retarget_to(standing(1, 30).save(tmp_path / name))
        clip = load_rig(moved.save(tmp_path / f"out_{name}"))
        scale = 1 if name == "own.glb" else 0.01
        order = [clip.names.index(joint) for joint in motion.skeleton.names]
        assert_allclose(clip.global_pose()[0][:, order] * scale, motion.positions(), atol=2e-3)
