"""Fingers and twist bones of a user's rig, by plain forward kinematics."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from characters import Character, character
from glb_files import glb
from rig_kinds import KINDS
from scipy.spatial.transform import Rotation

from motionrt import load_target
from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigMotion
from motionrt.rigs.plain_kinematics import joint_transforms


def moved(joint: str | None = None, vectors: np.ndarray | None = None, frames: int = 12) -> Motion:
    """A T-pose in which one joint turns by rotation vectors ``(F, 3)``."""
    rotations = np.tile(np.eye(3, dtype=np.float32), (frames, 24, 1, 1))
    if joint is not None and vectors is not None:
        rotations[:, SMPL24.index(joint)] = Rotation.from_rotvec(vectors).as_matrix()
    flying = Motion(rotations, np.zeros((frames, 3), np.float32), 30.0)
    height = -float(flying.positions()[0, [10, 11], 1].min())
    return replace(flying, root=np.tile(np.array([0, height, 0], np.float32), (frames, 1)))


def on(person: Character, motion: Motion, folder: Path, frames: str = "random") -> RigMotion:
    return motion.retarget_to(load_target(glb(person, frames=frames).save(folder / "rig.glb")))


def places(motion: RigMotion) -> dict[str, np.ndarray]:
    found = joint_transforms(motion.clip)[..., :3, 3]
    return {name: found[:, joint] for joint, name in enumerate(motion.names)}


def turn_of(motion: RigMotion, name: str, base: str) -> np.ndarray:
    """Rotation vectors ``(F, 3)`` in degrees of a joint against another, and against how both stand at rest."""
    turns, rest = joint_transforms(motion.clip)[..., :3, :3], motion.clip.rest_pose()[1].astype(float)
    one, two = motion.names.index(name), motion.names.index(base)
    before = rest[two].T @ rest[one]
    change = np.swapaxes(turns[:, two], -1, -2) @ turns[:, one] @ before.T
    return Rotation.from_matrix(change).as_rotvec(degrees=True)


@pytest.mark.parametrize("pose", ["t", "a"])
def test_stretched_fingers_hang_a_little_towards_the_palm_and_thumbs_stay(tmp_path: Path, pose: str) -> None:
    person = character("mixamo", pose=pose)
    found = places(on(person, moved(), tmp_path))
    for side in ("Left", "Right"):
        wrist, index = f"mixamorig:{side}Hand", f"mixamorig:{side}HandIndex"
        arm = found[wrist][0] - found[f"mixamorig:{side}ForeArm"][0]
        finger = found[f"{index}2"][0] - found[f"{index}1"][0]
        cosine = finger @ arm / np.linalg.norm(finger) / np.linalg.norm(arm)
        assert np.degrees(np.arccos(cosine)) == pytest.approx(20.05, abs=1.0)
        assert finger[1] < -0.3 * np.linalg.norm(finger)  # arms are held out: the palm faces the floor
        thumb = found[f"mixamorig:{side}HandThumb2"][0] - found[f"mixamorig:{side}HandThumb1"][0]
        assert np.cross(thumb, arm) == pytest.approx(0, abs=1e-6)
    left, right = (found[f"mixamorig:{side}HandMiddle2"][0] for side in ("Left", "Right"))
    assert left * [-1, 1, 1] == pytest.approx(right, abs=1e-4)


def test_fingers_that_are_bent_at_rest_stay_as_they_are(tmp_path: Path) -> None:
    person = character("mixamo")
    names, parents, spots = list(person.names), list(person.parents), person.places.copy()
    tip = names.index("mixamorig:LeftHandIndex2")
    bent = spots[tip] + [0.02, -0.03, 0]
    person = replace(
        person, names=[*names, "mixamorig:LeftHandIndex3"], parents=[*parents, tip], places=np.vstack([spots, bent])
    )
    result = on(person, moved(), tmp_path)
    assert turn_of(result, "mixamorig:LeftHandIndex1", "mixamorig:LeftHand") == pytest.approx(0, abs=0.1)
    assert np.abs(turn_of(result, "mixamorig:RightHandIndex1", "mixamorig:RightHand")).max() > 15


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_joint_inside_the_forearm_takes_half_of_the_turn_of_the_hand(tmp_path: Path, side: str) -> None:
    letter, swing = side[0].upper(), np.linspace(0, 1.4, 12)
    target = load_target(KINDS["MakeHuman"].write(tmp_path))
    still = moved().retarget_to(target)
    turning = moved(f"{side}_wrist", np.outer(swing, [1, 0, 0])).retarget_to(target)
    found = turn_of(turning, f"lowerarm02.{letter}", f"lowerarm01.{letter}")
    assert np.linalg.norm(found, axis=-1) == pytest.approx(np.degrees(swing) / 2, abs=1.0)
    wrist = f"wrist.{letter}"
    assert places(turning)[wrist] == pytest.approx(places(still)[wrist], abs=1e-4 * np.abs(places(still)[wrist]).max())
    hand = turn_of(turning, wrist, f"lowerarm01.{letter}")
    assert np.linalg.norm(hand, axis=-1) == pytest.approx(np.degrees(swing), abs=1.0)


def test_a_twist_bone_of_the_thigh_keeps_half_of_the_turn_from_the_hip(tmp_path: Path) -> None:
    turn = np.outer(np.linspace(0, 0.8, 12), [0, 1, 0])
    motion = moved("left_hip", turn)
    lifted = replace(motion, root=motion.root + np.array([0, 2, 0], np.float32))  # no foot near the floor
    result = on(character("unreal"), lifted, tmp_path)
    thigh = np.linalg.norm(turn_of(result, "thigh_l", "pelvis"), axis=-1)
    against = np.linalg.norm(turn_of(result, "thigh_l_twist_01", "thigh_l"), axis=-1)
    assert thigh[-1] == pytest.approx(np.degrees(0.8), abs=1.0)
    assert against == pytest.approx(thigh / 2, abs=1.0)
    assert turn_of(result, "thigh_r_twist_01", "thigh_r") == pytest.approx(0, abs=0.1)


def test_a_whole_turn_of_a_hand_makes_no_jump(tmp_path: Path) -> None:
    swing = np.linspace(0, 2 * np.pi, 60)
    motion = moved("left_wrist", np.outer(swing, [1, 0, 0]), frames=60)
    result = motion.retarget_to(load_target(KINDS["MakeHuman"].write(tmp_path)))
    found = Rotation.from_rotvec(turn_of(result, "lowerarm02.L", "lowerarm01.L"), degrees=True)
    steps = (found[:-1].inv() * found[1:]).magnitude()
    assert np.degrees(steps).max() < 6.0
