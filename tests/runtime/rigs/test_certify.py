"""Certification: rigs of common names pass, a rig that was broken on purpose does not, and mappings can be kept."""

from __future__ import annotations

import json
import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from characters import bvh_text, character
from glb_files import glb
from retarget_rigs import SIDED, person, rig
from scipy.spatial.transform import Rotation

from motionrt.cli import main
from motionrt.errors import InvalidInputError, RigError
from motionrt.formats import load_target
from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigMotion, played, to_rig, to_smpl24
from motionrt.rigs.certified import certified_mapping
from motionrt.rigs.certify import certify
from motionrt.rigs.mapping import draft_mapping, load_mapping, mapping_text, save_mapping
from motionrt.rigs.plain_kinematics import joint_transforms
from motionrt.rigs.probes import probe_motions

PRODUCTS = ("mixamo", "unreal", "unity", "cmu", "xsens", "rokoko")


@pytest.mark.parametrize("product", PRODUCTS)
def test_rigs_with_the_names_of_common_products_are_certified(tmp_path: Path, product: str) -> None:
    result = certify(load_target(glb(character(product)).save(tmp_path / "rig.glb")))
    assert result.passes, [probe for probe in result.probes if not probe.passes]
    assert result.sides
    assert 0.9 < result.hip_height < 1.1
    limbs = {
        result.mapping[f"{side}_{part}"] for side in ("left", "right") for part in ("hip", "knee", "shoulder", "elbow")
    }
    assert limbs <= set(result.driven)


@pytest.mark.parametrize(("joint", "below"), [("hip", "knee"), ("knee", "ankle"), ("shoulder", "elbow")])
@pytest.mark.parametrize("wide", [False, True])
def test_limbs_that_twist_as_they_move_fail(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, joint: str, below: str, wide: bool
) -> None:
    build = {"thigh": 0.15, "shank": 0.15, "arm": 0.25} if wide else {}
    target = load_target(glb(character("mixamo", **build)).save(tmp_path / "rig.glb"))
    assert certify(target).passes
    roles = draft_mapping(target.clip)
    upper, lower = (target.clip.names.index(roles[f"left_{part}"]) for part in (joint, below))

    def twisting(*args: object, **options: object) -> RigMotion:
        moved = to_rig(*args, **options)  # type: ignore[arg-type]
        axis = moved.clip.offsets[lower] / np.linalg.norm(moved.clip.offsets[lower])
        turn = Rotation.from_rotvec(np.outer(0.3 * np.sin(np.linspace(0, 6, moved.frames)), axis)).as_matrix()
        rotations = moved.clip.rotations.copy()
        rotations[:, upper] = rotations[:, upper] @ turn
        for child in (j for j, parent in enumerate(moved.clip.parents) if parent == upper):
            rotations[:, child] = np.swapaxes(turn, -1, -2) @ rotations[:, child]
        return replace(moved, clip=replace(moved.clip, rotations=rotations))

    monkeypatch.setattr(played, "to_rig", twisting)
    result = certify(target)
    assert not result.passes
    assert max(probe.twist for probe in result.probes) > 10
    assert max(probe.hands_cm + probe.feet_cm for probe in result.probes) < 0.5  # nothing else is wrong


def test_knees_that_point_aside_fail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = load_target(glb(character("mixamo")).save(tmp_path / "rig.glb"))

    def splayed(*args: object, **options: object) -> RigMotion:
        moved = to_rig(*args, **options)  # type: ignore[arg-type]
        hip, knee, ankle = (
            moved.clip.names.index(draft_mapping(target.clip)[f"left_{p}"]) for p in ("hip", "knee", "ankle")
        )
        places, turns = moved.clip.global_pose()
        line = places[:, ankle] - places[:, hip]
        axis = line / np.linalg.norm(line, axis=-1, keepdims=True)
        aside = Rotation.from_rotvec(axis * np.deg2rad(20)).as_matrix()
        rotations = moved.clip.rotations.copy()
        above = turns[:, moved.clip.parents[hip]]
        rotations[:, hip] = np.swapaxes(above, -1, -2) @ aside @ turns[:, hip]
        rotations[:, ankle] = np.swapaxes(aside @ turns[:, knee], -1, -2) @ turns[:, ankle]
        return replace(moved, clip=replace(moved.clip, rotations=rotations))

    monkeypatch.setattr(played, "to_rig", splayed)
    assert max(probe.twist for probe in certify(target).probes if probe.name == "squat") > 15


def test_a_rig_whose_arms_are_mapped_the_wrong_way_round_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "rig.bvh"
    path.write_text(bvh_text(character("mixamo")))
    target = load_target(path)
    right = draft_mapping(target.clip)
    wrong = {}
    for part in ("collar", "shoulder", "elbow", "wrist", "hand"):
        wrong[f"left_{part}"], wrong[f"right_{part}"] = right[f"right_{part}"], right[f"left_{part}"]
    legs = {role: name for role, name in right.items() if role.endswith(("hip", "knee", "ankle", "foot"))}
    with pytest.raises(RigError, match="no known standing pose"):
        certify(target, mapping={**wrong, **legs})


def test_the_plain_kinematics_of_the_check_agree_with_those_of_the_motion() -> None:
    motion = person(10)
    clip = rig(motion)
    places = joint_transforms(clip)[..., :3, 3]
    assert np.abs(places - motion.positions()).max() < 1e-5


def test_probe_motions_stand_on_the_floor_and_move_what_they_say() -> None:
    probes = probe_motions()
    for motion in probes.values():
        toes = motion.positions()[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")], 1]
        assert abs(float(toes.min(axis=1).max())) < 1e-4
    wrists = probes["left arm alone"].positions()[:, [SMPL24.index("left_wrist"), SMPL24.index("right_wrist")]]
    assert np.ptp(wrists[:, 0, 1]) > 0.3
    assert np.ptp(wrists[:, 1, 1]) < 0.01


def test_a_mapping_file_is_drafted_kept_and_believed(tmp_path: Path) -> None:
    truth = person()
    odd = {name: f"zz {joint}: 'x\"y\\" for joint, name in enumerate(SMPL24.names)}
    clip = rig(truth, odd)
    path = save_mapping(draft_mapping(clip), tmp_path / "rig.yaml")
    mapping = load_mapping(path)
    assert mapping["left_knee"] == odd["left_knee"]
    (tmp_path / "rig.json").write_text('{"left_hip": "a", "right_hip": "b"}')
    assert load_mapping(tmp_path / "rig.json") == {"left_hip": "a", "right_hip": "b"}
    turned = to_smpl24(clip, mapping=mapping)
    assert np.abs(turned.positions()[:, 4:6] - truth.positions()[:, 4:6]).max() < 0.02


BOMB = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
    f"{chr(98 + n)}: &{chr(98 + n)} [{', '.join([f'*{chr(97 + n)}'] * 9)}]\n" for n in range(20)
)


@pytest.mark.parametrize(
    "content", ["[1, 2]", "left_hip: 3", "{", "left_hip: [a]", "a: &x [*x]", BOMB, "a: 2001-13-45", "[" * 999]
)
def test_what_is_no_mapping_is_refused(tmp_path: Path, content: str) -> None:
    path = tmp_path / "rig.yaml"
    path.write_text(content)
    with pytest.raises(InvalidInputError, match=r"mapping|must map"):
        load_mapping(path)


def test_a_mapping_that_is_a_pipe_or_is_not_there_is_refused_at_once(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="no such file"):
        load_mapping(tmp_path / "none.yaml")
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.yaml")
        with pytest.raises(InvalidInputError, match="is a pipe"):
            load_mapping(tmp_path / "pipe.yaml")


CONVENTIONS = {
    "Auto-Rig Pro": (
        "{}",
        "thigh_stretch.S leg_stretch.S foot.S toes_01.S shoulder.S arm_stretch.S forearm_stretch.S hand.S middle1.S",
    ),
    "Rigify": ("DEF-{}", "thigh.S shin.S foot.S toe.S shoulder.S upper_arm.S forearm.S hand.S f_middle.01.S"),
    "VRoid": ("J_Bip_{}", "S_UpperLeg S_LowerLeg S_Foot S_ToeBase S_Shoulder S_UpperArm S_LowerArm S_Hand S_Middle1"),
    "Daz": ("{}", "SThigh SShin SFoot SToe SCollar SShldr SForeArm SHand SMid1"),
    "MakeHuman": (
        "{}",
        "upperleg01.S lowerleg01.S foot.S toe.S clavicle.S upperarm01.S lowerarm01.S wrist.S finger3-1.S",
    ),
    "Perception Neuron": ("{}", "SUpLeg SLeg SFoot SToeBase SShoulder SArm SForeArm SHand SInHandMiddle"),
    "LaFAN1": ("{}", "SUpLeg SLeg SFoot SToe SShoulder SArm SForeArm SHand SHandEnd1"),
    "100STYLE": ("{}", "SHip SKnee SAnkle SToe SCollar SShoulder SElbow SWrist SWristTip1"),
    "Bandai": ("{}", "UpperLeg_S LowerLeg_S Foot_S Toes_S Shoulder_S UpperArm_S LowerArm_S Hand_S Middle1_S"),
    "KayKit": ("{}", "upperleg.S lowerleg.S foot.S toes.S clavicle.S upperarm.S lowerarm.S wrist.S hand.S"),
    "MMD": ("{}", "S足 Sひざ S足首 Sつま先 S肩 S腕 Sひじ S手首 S中指１"),
}
LETTERS = {"Auto-Rig Pro": "lr", "Daz": "lr", "KayKit": "lr", "MMD": "左右", "Rigify": "LR", "VRoid": "LR"}
LETTERS |= {"MakeHuman": "LR", "Bandai": "LR"}


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_every_naming_convention_reads_as_the_same_motion(convention: str) -> None:
    truth = person(30)
    form, parts = CONVENTIONS[convention]
    first, second = LETTERS.get(convention, ("Left", "Right"))
    middle = {
        "pelvis": "Hips",
        "spine1": "Spine",
        "spine2": "Chest",
        "spine3": "UpperChest",
        "neck": "Neck",
        "head": "Head",
    }
    names = {role: form.format(name) for role, name in middle.items()}
    for part, name in zip(SIDED, parts.split(), strict=True):
        for side, letter in (("left", first), ("right", second)):
            names[f"{side}_{part}"] = form.format(sided(name, letter))
    assert worst(to_smpl24(rig(truth, names, scale=100, rest="a")), truth) < 1.0


def sided(name: str, side: str) -> str:
    """``name`` with the mark of its side: an S at the start, between separators or at the end."""
    return re.sub(r"^S(?=[A-Z_\u3000-\u9fff])|(?<=[._])S$", side, name)


def worst(one: Motion, two: Motion) -> float:
    """Largest mean angle in degrees between bones."""
    parents = list(SMPL24.parents[1:22])
    a, b = (motion.positions()[:, :22].astype(float) for motion in (one, two))
    a, b = a[:, 1:] - a[:, parents], b[:, 1:] - b[:, parents]
    cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean(0).max())


def test_the_text_of_a_mapping_lists_joints_from_the_pelvis_outwards() -> None:
    text = mapping_text({"left_knee": "b", "pelvis": "a"})
    assert text.splitlines() == ["# smpl24 joint: joint of the rig", 'pelvis: "a"', 'left_knee: "b"']


@pytest.mark.parametrize("product", ["mixamo", "unreal"])
def test_a_program_that_reads_the_certified_mapping_turns_the_limbs_as_the_probe(tmp_path: Path, product: str) -> None:
    file = glb(character(product)).save(tmp_path / "rig.glb")
    rig_json = tmp_path / "rig.json"
    assert main(["rig", "map", str(file), "--json", "-o", str(rig_json)]) == 0
    known = json.loads(rig_json.read_text(encoding="utf-8"))
    assert known["certified"]
    assert known["worst"]["hands_cm"] <= 2
    target, motion = load_target(file), probe_motions()["walk on the spot"]
    turns, clip = motion.global_rotations().astype(float), target.clip
    world = Rotation.from_quat(known["to_world"]).as_matrix()
    rest, rest_turns = clip.rest_positions().astype(float), clip.rest_pose()[1].astype(float)
    for side in ("left", "right"):
        for upper, lower in (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")):
            top, end = (f"{side}_{part}" for part in (upper, lower))
            joint, below = (clip.names.index(known["mapping"][role]) for role in (top, end))
            bone = rest_turns[joint].T @ (rest[below] - rest[joint])
            alignment = Rotation.from_quat(known["alignments"][clip.names[joint]]).as_matrix()
            ours = world.T @ turns[:, SMPL24.index(top)] @ alignment.T @ bone
            points = motion.positions().astype(float)
            theirs = (points[:, SMPL24.index(end)] - points[:, SMPL24.index(top)]) @ world
            cosine = (ours * theirs).sum(-1) / np.linalg.norm(ours, axis=-1) / np.linalg.norm(theirs, axis=-1)
            assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 3, (top, end)


def test_a_certified_mapping_can_be_given_back_as_a_mapping(tmp_path: Path) -> None:
    file = glb(character("unity")).save(tmp_path / "rig.glb")
    saved = tmp_path / "rig.json"
    saved.write_text(json.dumps(certified_mapping(load_target(file))), encoding="utf-8")
    assert load_mapping(saved) == draft_mapping(load_target(file).clip)
