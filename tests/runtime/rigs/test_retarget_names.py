"""Retargeting finds the joints of every common naming convention, and of rigs with no names worth reading."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from retarget_rigs import named, person, renamed, rig

from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigClip
from motionrt.rigs.joint_names import read_joint_name
from motionrt.rigs.retarget_in import to_smpl24

SPINE = ("pelvis", "spine1", "spine2", "spine3", "neck", "head")
MIXAMO = "{}UpLeg {}Leg {}Foot {}ToeBase {}Shoulder {}Arm {}ForeArm {}Hand {}HandMiddle1"
MIXAMO_SPINE = "Hips Spine Spine1 Spine2 Neck Head"


def convention(limbs: str, spine: str, sides: tuple[str, str] = ("Left", "Right"), prefix: str = "") -> dict[str, str]:
    """smpl24 name -> rig name: nine limb joints, hip to hand, ``{}`` for the side; then pelvis to head."""
    names = renamed(named(*limbs.split()), sides, **dict(zip(SPINE, spine.split(), strict=True)))
    return {joint: prefix + name.replace("~", " ") for joint, name in names.items()}


CONVENTIONS = {
    "mixamo": convention(MIXAMO, MIXAMO_SPINE, prefix="mixamorig:"),
    "mixamo_numbered": convention(MIXAMO, MIXAMO_SPINE, prefix="mixamorig9_"),
    "motionbuilder_namespace": convention(MIXAMO, MIXAMO_SPINE, prefix="Bob|Character1:"),
    "unity": convention(
        "{}UpperLeg {}LowerLeg {}Foot {}Toes {}Shoulder {}UpperArm {}LowerArm {}Hand {}MiddleProximal",
        "Hips Spine Chest UpperChest Neck Head",
    ),
    "hip_knee": convention(
        "{}Hip {}Knee {}Ankle {}Toe {}Collar {}Shoulder {}Elbow {}Wrist {}Wrist_end",
        "Hips Chest Chest2 Chest3 Neck Head",
    ),
    "unreal": convention(
        "thigh_{} calf_{} foot_{} ball_{} clavicle_{} upperarm_{} lowerarm_{} hand_{} middle_01_{}",
        "pelvis spine_01 spine_02 spine_03 neck_01 head",
        ("l", "r"),
    ),
    "smpl": convention(
        "{}_Hip {}_Knee {}_Ankle {}_Foot {}_Collar {}_Shoulder {}_Elbow {}_Wrist {}_Hand",
        "Pelvis Spine1 Spine2 Spine3 Neck Head",
        ("L", "R"),
    ),
    "smpl_avatar": convention(
        "{}_Hip {}_Knee {}_Ankle {}_Foot {}_Collar {}_Shoulder {}_Elbow {}_Wrist {}_Hand",
        "Pelvis Spine1 Spine2 Spine3 Neck Head",
        ("L", "R"),
        prefix="m_avg_",
    ),
    "asf": convention(
        "{}femur {}tibia {}foot {}toes {}clavicle {}humerus {}radius {}wrist {}hand",
        "root lowerback upperback thorax lowerneck head",
        ("l", "r"),
    ),
    "daz": convention(
        "{}Thigh {}Shin {}Foot {}Toe {}Collar {}Shldr {}ForeArm {}Hand {}Mid1",
        "hip abdomen abdomen2 chest neck head",
        ("l", "r"),
    ),
    "genesis": convention(
        "{}ThighBend {}Shin {}Foot {}Toe {}Collar {}ShldrBend {}ForearmBend {}Hand {}Mid1",
        "pelvis abdomenLower abdomenUpper chestLower neckLower head",
        ("l", "r"),
    ),
    "biped": convention(
        "{}~Thigh {}~Calf {}~Foot {}~Toe0 {}~Clavicle {}~UpperArm {}~Forearm {}~Hand {}~Finger2",
        "Pelvis Spine Spine1 Spine2 Neck Head",
        ("L", "R"),
        prefix="Bip01 ",
    ),
    "rigify": convention(
        "thigh.{} shin.{} foot.{} toe.{} shoulder.{} upper_arm.{} forearm.{} hand.{} f_middle.01.{}",
        "spine spine.001 spine.002 spine.003 spine.004 spine.006",
        ("L", "R"),
    ),
    "rokoko": convention(
        "{}Thigh {}Shin {}Foot {}Toe {}Shoulder {}Arm {}ForeArm {}Hand {}Finger3Proximal",
        "Hips Spine1 Spine2 Spine3 Neck Head",
    ),
    "xsens": convention(
        "{}UpperLeg {}LowerLeg {}Foot {}Toe {}Shoulder {}UpperArm {}ForeArm {}Hand {}Hand_end",
        "Pelvis L5 L3 T8 Neck Head",
    ),
    "vroid": convention(
        "{}_UpperLeg {}_LowerLeg {}_Foot {}_ToeBase {}_Shoulder {}_UpperArm {}_LowerArm {}_Hand {}_Middle1",
        "C_Hips C_Spine C_Chest C_UpperChest C_Neck C_Head",
        ("L", "R"),
        prefix="J_Bip_",
    ),
    "kinect": convention(
        "Hip{} Knee{} Ankle{} Foot{} Clavicle{} Shoulder{} Elbow{} Wrist{} Hand{}",
        "HipCenter SpineNaval SpineMid SpineChest Neck Head",
    ),
    "joint_suffix": convention(
        "{}_hip_jnt {}_knee_jnt {}_ankle_jnt {}_toe_jnt"
        " {}_clav_jnt {}_shoulder_jnt {}_elbow_jnt {}_wrist_jnt {}_mid_jnt",
        "c_pelvis_jnt c_spine_01_jnt c_spine_02_jnt c_spine_03_jnt c_neck_jnt c_head_jnt",
        ("lf", "rt"),
    ),
    "leg_knee_ankle": convention(
        "leg_{} knee_{} ankle_{} toe_{} shoulder_{} arm_{} elbow_{} wrist_{} middle_{}",
        "center_hips s1 s2 s3 neck head",
        ("left", "right"),
    ),
    "numbers": {name: f"{7 * joint % 24:03d}" for joint, name in enumerate(SMPL24.names)},
    "foreign": {name: f"ほね{joint}" for joint, name in enumerate(SMPL24.names)},
}


def error(found: Motion, truth: Motion) -> float:
    gap = found.positions() - truth.positions()
    gap[..., 1] -= np.median(gap[:, 0, 1])
    return float(np.linalg.norm(gap, axis=-1).max())


@pytest.mark.parametrize("style", CONVENTIONS)
def test_convention_is_understood(style: str) -> None:
    truth = person(30)
    clip = rig(truth, CONVENTIONS[style], scale=100, rest="a")
    assert error(to_smpl24(clip), truth) < 1e-3


@pytest.mark.parametrize("mirrored", [False, True])
def test_nameless_rig_keeps_its_sides_in_whatever_order_they_stand(mirrored: bool) -> None:
    truth = person(30)
    names = {name: f"j{joint}" for joint, name in enumerate(SMPL24.names)}
    if mirrored:
        names = {a: names[SMPL24.names[b]] for a, b in zip(SMPL24.names, SMPL24.mirrored_joints, strict=True)}
    assert error(to_smpl24(rig(truth, names, rest="bones_up")), truth) < 0.06
    assert error(to_smpl24(rig(truth, names)), truth) < 1e-3


def test_cgspeed_helpers_and_zero_bones_do_not_get_roles() -> None:
    names = convention(MIXAMO, "Hips LowerBack Spine Spine1 Neck Head")
    truth = person(30)
    clip = rig(truth, names)
    joint = clip.names.index("LeftUpLeg")
    parents = tuple(p + (p >= joint) for p in clip.parents)
    helped = replace(
        clip,
        names=(*clip.names[:joint], "LHipJoint", *clip.names[joint:]),
        parents=(*parents[:joint], 0, joint, *parents[joint + 1 :]),
        offsets=np.insert(clip.offsets, joint, 0, axis=0),
        rotations=np.insert(clip.rotations, joint, np.eye(3), axis=1),
        translations=np.insert(clip.translations, joint, 0, axis=1),
    )
    assert error(to_smpl24(helped), truth) < 1e-4


@pytest.mark.parametrize(
    "dropped",
    [
        ("spine1", "spine2"),
        ("spine1", "spine2", "spine3"),
        ("neck",),
        ("left_collar", "right_collar"),
        ("left_foot", "right_foot"),
        ("left_hand", "right_hand"),
    ],
)
def test_optional_joints_may_be_missing(dropped: tuple[str, ...]) -> None:
    truth = person(30)
    names = {joint: name for joint, name in CONVENTIONS["smpl"].items() if joint not in dropped}
    found = to_smpl24(rig(truth, names))
    legs = [SMPL24.index(f"{side}_{part}") for side in ("left", "right") for part in ("hip", "knee", "ankle")]
    gap = found.positions() - truth.positions()
    gap[..., 1] -= np.median(gap[:, 0, 1])
    assert np.linalg.norm(gap[:, legs], axis=-1).max() < 0.02
    assert np.linalg.norm(gap, axis=-1).max() < 0.25


def test_longer_spines_and_necks_are_resampled() -> None:
    """Two joints in every place of one: the outer ones carry the rotation, the inner ones stand still."""
    truth = person(30)
    clip = doubled(rig(truth, CONVENTIONS["smpl"]), ("Spine1", "Spine2", "Spine3", "Neck"))
    found = to_smpl24(clip)
    assert error(found, truth) < 0.01


def doubled(clip: RigClip, which: tuple[str, ...]) -> RigClip:
    for name in which:
        joint = clip.names.index(name)
        parents = [p + (p >= joint) for p in clip.parents]
        clip = replace(
            clip,
            names=(*clip.names[:joint], f"{name}_base", *clip.names[joint:]),
            parents=(*parents[:joint], clip.parents[joint], joint, *parents[joint + 1 :]),
            offsets=np.insert(clip.offsets, joint, 0, axis=0),
            rotations=np.insert(clip.rotations, joint, np.eye(3), axis=1),
            translations=np.insert(clip.translations, joint, 0, axis=1),
        )
    return clip


@pytest.mark.parametrize(
    ("name", "side", "part"),
    [
        ("mixamorig:LeftUpLeg", "left", "thigh"),
        ("Bip01 R Calf", "right", "shin"),
        ("upper_arm.L", "left", "upperarm"),
        ("r_humerus", "right", "upperarm"),
        ("lradius", "left", "forearm"),
        ("radius", "", "forearm"),
        ("LFingers", "left", "fingers"),
        ("CC_Base_R_Foot", "right", "foot"),
        ("LHipJoint", "left", "hipjoint"),
        ("Hips", "", "hip"),
        ("upleg_left", "left", "thigh"),
        ("righthand", "right", "hand"),
    ],
)
def test_names_are_read(name: str, side: str, part: str) -> None:
    reading = read_joint_name(name)
    assert reading is not None
    assert (reading.side, reading.part) == (side, part)


@pytest.mark.parametrize(
    "name",
    [
        "lButtock",
        "thigh_twist_01_l",
        "ik_foot_l",
        "LThumb",
        "Head_end",
        "HeadTop_End",
        "Spine",
        "17",
        "骨",
        "",
    ],
)
def test_helpers_and_unknown_names_are_not_read(name: str) -> None:
    assert read_joint_name(name) is None


def test_a_root_above_the_hips_may_carry_the_travel() -> None:
    truth = person(30)
    clip = rig(truth, CONVENTIONS["smpl"], scale=100)
    translations = np.insert(clip.translations, 0, clip.translations[:, 0] + np.array([5000, 0, 0]), axis=1)
    translations[:, 1] = 0
    stage = replace(
        clip,
        names=("Reference", *clip.names),
        parents=(-1, *(p + 1 for p in clip.parents)),
        offsets=np.insert(clip.offsets, 0, 0, axis=0),
        rotations=np.insert(clip.rotations, 0, np.eye(3), axis=1),
        translations=translations,
    )
    below = replace(
        stage,
        translations=np.where(np.arange(25)[:, None] < 2, translations[:, [1, 0, *range(2, 25)]], translations),
    )
    for moved in (stage, below):
        found = to_smpl24(moved)
        assert error(replace(found, root=found.root - np.array([50, 0, 0], np.float32)), truth) < 2e-3
