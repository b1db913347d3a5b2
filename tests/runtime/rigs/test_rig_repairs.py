"""What rigs get wrong in silence: bent rest poses, cancelled rotations, sides that disagree; all made here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from retarget_rigs import named, person, renamed, rig
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigClip, to_smpl24

Array = npt.NDArray[np.float64]
NAMES = renamed(
    named("{}UpLeg", "{}Leg", "{}Foot", "{}ToeBase", "{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand", "{}HandMiddle1"),
    pelvis="Hips",
    spine1="Spine",
    spine2="Spine1",
    spine3="Spine2",
    neck="Neck",
    head="Head",
)


def degrees(one: Array, two: Array) -> Array:
    """Angle between vectors."""
    cosine = (one * two).sum(-1) / np.linalg.norm(one, axis=-1) / np.linalg.norm(two, axis=-1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def worst_bone(one: Motion, two: Motion) -> float:
    """Largest mean angle in degrees between the bones of two motions."""
    first, second = one.positions().astype(float), two.positions().astype(float)
    parents = list(SMPL24.parents[1:])
    return float(degrees(first[:, 1:] - first[:, parents], second[:, 1:] - second[:, parents]).mean(0).max())


def bent(clip: RigClip, knee: float, elbow: float) -> RigClip:
    """``clip`` on a figure whose shanks and forearms stand bent at rest; its rotations stay."""
    offsets, translations = clip.offsets.copy(), clip.translations.copy()
    turns = {"Foot": [np.radians(knee), 0, 0], "Left": [0, np.radians(-elbow), 0], "Right": [0, np.radians(elbow), 0]}
    for side in ("Left", "Right"):
        for end, vector in ((f"{side}Foot", turns["Foot"]), (f"{side}Hand", turns[side])):
            joint = clip.names.index(end)
            turn = Rotation.from_rotvec(vector).as_matrix()
            offsets[joint], translations[:, joint] = turn @ offsets[joint], translations[:, joint] @ turn.T
    return replace(clip, offsets=offsets.astype(np.float32), translations=translations.astype(np.float32))


def bend_of(motion: Motion, *line: str) -> Array:
    """Bend of a limb in degrees."""
    top, middle, end = (motion.positions()[:, SMPL24.index(name)].astype(float) for name in line)
    return degrees(middle - top, end - middle)


KNEE, ELBOW = ("left_hip", "left_knee", "left_ankle"), ("right_shoulder", "right_elbow", "right_wrist")


def test_a_rest_pose_bent_under_rotations_made_for_straight_limbs_is_straightened() -> None:
    truth = person()
    clip = bent(rig(truth, NAMES), 8, 17)
    out = to_smpl24(clip, reference=clip.rest_rotations())
    for limb in (KNEE, ELBOW):
        assert np.abs(bend_of(out, *limb) - bend_of(truth, *limb)).max() < 2.0  # the knees of smpl24 stand at 1.4


@pytest.mark.parametrize("with_reference", [True, False])
def test_a_bent_rest_pose_of_a_file_that_is_right_stays_as_it_is(with_reference: bool) -> None:
    """Joints that turn about more than one axis, or a file without a calibration pose: positions are believed."""
    truth = person()
    clip = bent(rig(truth, NAMES), 8, 17)
    if with_reference:
        twist = np.sin(np.arange(truth.frames) / 5)[:, None] * np.array([0.0, 0.4, 0.0])
        for side in ("Left", "Right"):
            joint = clip.names.index(f"{side}Leg")
            clip.rotations[:, joint] = clip.rotations[:, joint] @ Rotation.from_rotvec(twist).as_matrix()
    out = to_smpl24(clip, reference=clip.rest_rotations() if with_reference else None)
    places = clip.global_pose()[0].astype(float)
    for limb, joints in (
        (KNEE, ("LeftUpLeg", "LeftLeg", "LeftFoot")),
        (ELBOW, ("RightArm", "RightForeArm", "RightHand")),
    ):
        top, middle, end = (places[:, clip.names.index(name)] for name in joints)
        assert np.abs(bend_of(out, *limb) - degrees(middle - top, end - middle)).max() < 0.5


def cancelled(clip: RigClip, joint: str, below: tuple[str, ...], turns: Array) -> RigClip:
    """``clip`` with ``joint`` turned by ``turns`` and a joint of no length above each of ``below`` that undoes it."""
    names, parents = list(clip.names), list(clip.parents)
    offsets, rotations, translations = clip.offsets, clip.rotations.copy(), clip.translations
    top = names.index(joint)
    rotations[:, top] = rotations[:, top] @ turns
    for name in below:
        child = names.index(name)
        names.insert(child, f"zero_{name}")
        parents = [parent + (parent >= child) for parent in parents]
        parents.insert(child, top)
        parents[child + 1] = child
        offsets = np.insert(offsets, child, 0, axis=0)
        translations = np.insert(translations, child, 0, axis=1)
        rotations = np.insert(rotations, child, np.swapaxes(turns, -1, -2), axis=1)
    return RigClip(tuple(names), tuple(parents), offsets, rotations.astype(np.float32), translations, clip.fps)


@pytest.mark.parametrize(
    ("joint", "below"),
    [("Hips", ("LeftUpLeg", "RightUpLeg", "Spine")), ("Spine2", ("Neck", "LeftShoulder", "RightShoulder"))],
)
def test_a_rotation_that_joints_of_no_length_cancel_does_not_reach_the_body(joint: str, below: tuple[str, ...]) -> None:
    truth = person()
    turns = Rotation.from_rotvec(np.outer(np.sin(np.arange(truth.frames) / 7), [0.5, 0.7, 0.2])).as_matrix()
    clip = cancelled(rig(truth, NAMES), joint, below, turns)
    assert np.abs(clip.global_pose()[0][:, -1] - rig(truth, NAMES).global_pose()[0][:, -1]).max() < 1e-5
    assert worst_bone(to_smpl24(clip), truth) < 2.0


def test_hips_that_are_moved_by_themselves_set_the_line_of_the_pelvis() -> None:
    truth = person()
    clip = rig(truth, NAMES)
    sway = Rotation.from_rotvec(np.outer(0.4 * np.sin(np.arange(truth.frames) / 4), [0, 1, 0])).as_matrix()
    for side in ("Left", "Right"):
        joint = clip.names.index(f"{side}UpLeg")
        clip.translations[:, joint] = np.einsum("fij,j->fi", sway, clip.offsets[joint])
    places = clip.global_pose()[0].astype(float)
    line = places[:, clip.names.index("LeftUpLeg")] - places[:, clip.names.index("RightUpLeg")]
    out = to_smpl24(clip).positions().astype(float)
    assert degrees(out[:, 1] - out[:, 2], line).max() < 1.0


def test_markers_with_names_of_bones_do_not_take_the_place_of_joints_with_limbs() -> None:
    truth = person()
    clip = rig(truth, {role: f"Character1_{name}" for role, name in NAMES.items()})
    for marker, wrong in (("L_Humerus", "RightArm"), ("R_Humerus", "LeftArm"), ("R_Femur", "LeftUpLeg")):
        clip = RigClip(
            (*clip.names, marker),
            (*clip.parents, clip.names.index(f"Character1_{wrong}")),
            np.vstack([clip.offsets, [[0.02, 0, 0]]]).astype(np.float32),
            np.concatenate([clip.rotations, np.tile(np.eye(3, dtype=np.float32), (clip.frames, 1, 1, 1))], axis=1),
            np.concatenate([clip.translations, np.full((clip.frames, 1, 3), 0.02, np.float32)], axis=1),
            clip.fps,
        )
    assert worst_bone(to_smpl24(clip), truth) < 0.5


@pytest.mark.parametrize("arms_right_first", [False, True])
@pytest.mark.parametrize("legs_right_first", [False, True])
def test_legs_and_arms_without_names_are_on_the_same_side(arms_right_first: bool, legs_right_first: bool) -> None:
    truth = person()
    clip = reordered(rig(truth, {name: name for name in SMPL24.names}), legs_right_first, arms_right_first)
    numbers = tuple(f"bone{joint:02d}" for joint in range(len(clip.names)))
    assert worst_bone(to_smpl24(replace(clip, names=numbers)), truth) < 0.5


def reordered(clip: RigClip, legs_right_first: bool, arms_right_first: bool) -> RigClip:
    """The joints in another order of siblings."""
    order: list[int] = []

    def visit(joint: int) -> None:
        order.append(joint)
        below = [child for child, parent in enumerate(clip.parents) if parent == joint]
        turned = legs_right_first if joint == 0 else arms_right_first
        for child in sorted(below, key=lambda j: clip.names[j].startswith("right") != turned):
            visit(child)

    visit(0)
    parents = tuple(order.index(clip.parents[j]) if clip.parents[j] >= 0 else -1 for j in order)
    names = tuple(clip.names[j] for j in order)
    return RigClip(names, parents, clip.offsets[order], clip.rotations[:, order], clip.translations[:, order], clip.fps)


def test_side_words_bind_where_the_parts_are_unknown_words() -> None:
    truth = person()
    words = ("gamba", "polpa", "piede", "dita", "scap", "braccio", "avambr", "polso", "mano")
    names = {role: f"zz_{joint:02d}" for joint, role in enumerate(SMPL24.names)}
    names |= renamed(named(*(f"{word}.{{}}" for word in words)), ("L", "R"))
    clip = reordered(rig(truth, {role: names[role] for role in SMPL24.names}), True, False)
    assert worst_bone(to_smpl24(clip), truth) < 0.5


def test_arms_named_for_the_other_side_than_the_legs_follow_the_body() -> None:
    truth = person()
    mixed = dict(NAMES)
    for part in ("collar", "shoulder", "elbow", "wrist", "hand"):
        mixed[f"left_{part}"], mixed[f"right_{part}"] = NAMES[f"right_{part}"], NAMES[f"left_{part}"]
    assert worst_bone(to_smpl24(rig(truth, mixed)), truth) < 0.5
