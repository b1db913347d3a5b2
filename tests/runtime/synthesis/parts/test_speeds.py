"""Parts by speed: motions whose moving joints are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from motions import standing, walking
from scipy.spatial.transform import Rotation

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24, Motion
from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.parts import part_speeds, relative_velocity_parts, velocity_parts

FPS = 30.0


def swinging(joint: str, axis: int = 0, amplitude: float = 0.6) -> Motion:
    """Only one joint swings, at 1 Hz."""
    still = standing(60, FPS)
    vectors = np.zeros((60, 3))
    vectors[:, axis] = amplitude * np.sin(2 * np.pi * np.arange(60) / FPS)
    rotations = still.rotations.copy()
    rotations[:, SMPL24.index(joint)] = Rotation.from_rotvec(vectors).as_matrix()
    return replace(still, rotations=rotations)


@pytest.mark.parametrize(
    ("joint", "axis", "expected"),
    [
        ("left_shoulder", 2, "left arm"),
        ("right_elbow", 1, "right arm"),
        ("left_hip", 0, "left leg"),
        ("right_knee", 0, "right leg"),
        ("spine1", 0, "torso"),
    ],
)
def test_one_swinging_joint_is_one_part(joint: str, axis: int, expected: str) -> None:
    assert velocity_parts(swinging(joint, axis)) == {expected}


def test_a_nod_is_slower_than_the_sway_of_a_walk_and_takes_a_threshold_of_its_own() -> None:
    nod = swinging("neck")
    assert velocity_parts(nod) == frozenset()
    assert velocity_parts(nod, torso=0.2) == {"torso"}


def test_a_trunk_that_sways_with_the_steps_is_not_the_torso() -> None:
    assert "torso" not in velocity_parts(swinging("spine1", 2, amplitude=0.1))


def test_standing_still_is_no_part_and_one_frame_neither() -> None:
    assert velocity_parts(standing(30)) == frozenset() == velocity_parts(standing(1))


def test_walking_is_legs_and_global_and_arms_that_swing() -> None:
    assert velocity_parts(walking(speed=1.2)) >= {"left leg", "right leg", "global"}


def test_being_carried_is_global_alone() -> None:
    still = standing(60, FPS)
    root = still.root + np.linspace(0, 2, 60)[:, None] * np.array([0, 0, 1])
    assert velocity_parts(replace(still, root=root)) == {"global"}


def test_turning_on_the_spot_is_global_alone_and_at_the_rate_it_turns() -> None:
    still = standing(60, FPS)
    rotations = still.rotations.copy()
    rotations[:, 0] = Rotation.from_rotvec(np.arange(60)[:, None] / FPS * np.array([0, 2.0, 0])).as_matrix()
    turning = replace(still, rotations=rotations)
    assert velocity_parts(turning) == {"global"}
    assert part_speeds(turning)["turning"] == pytest.approx(2.0, abs=1e-3)


def test_speed_is_that_of_the_joint_on_its_lever() -> None:
    rate = 1.5
    still = standing(31, FPS)
    rotations = still.rotations.copy()
    angles = np.arange(31)[:, None] / FPS * np.array([rate, 0, 0])
    rotations[:, SMPL24.index("left_knee")] = Rotation.from_rotvec(angles).as_matrix()
    rest = SMPL24.rest_positions
    lever = np.linalg.norm((rest[SMPL24.index("left_foot")] - rest[SMPL24.index("left_knee")])[1:])
    chord = 2 * lever * np.sin(rate / FPS / 2) * FPS  # metres per second between frames
    assert part_speeds(replace(still, rotations=rotations))["left leg"] == pytest.approx(chord, rel=1e-3)


def test_the_threshold_is_in_metres_per_second() -> None:
    motion = swinging("left_shoulder", 2)
    speed = part_speeds(motion)["left arm"]
    assert velocity_parts(motion, threshold=speed * 0.99) == {"left arm"}
    assert velocity_parts(motion, threshold=speed * 1.01) == frozenset()


def test_speeds_do_not_depend_on_the_frame_rate_nor_on_where_it_happens() -> None:
    motion = swinging("right_hip")
    speeds = part_speeds(motion)
    slower = part_speeds(motion.resample(15))
    for part in PARTS:
        assert slower[part] == pytest.approx(speeds[part], rel=0.05, abs=1e-4)
    moved = replace(motion, root=motion.root + np.array([5, 0, -3]))
    assert part_speeds(moved)["right leg"] == pytest.approx(speeds["right leg"], rel=1e-3)


@pytest.mark.parametrize("threshold", [-1.0, float("nan")])
def test_a_threshold_below_zero_is_an_error(threshold: float) -> None:
    with pytest.raises(InvalidInputError, match="thresholds"):
        velocity_parts(standing(5), threshold=threshold)


def test_as_published_the_parts_that_are_fast_beside_the_others_move() -> None:
    rotations = np.tile(np.eye(3, dtype=np.float32), (30, 24, 1, 1))
    angle = np.sin(np.arange(30) / 3.0)
    elbow = SMPL24.index("right_shoulder")
    rotations[:, elbow, 0, 0] = rotations[:, elbow, 1, 1] = np.cos(angle)
    rotations[:, elbow, 1, 0], rotations[:, elbow, 0, 1] = np.sin(angle), -np.sin(angle)
    waving = Motion(rotations, np.zeros((30, 3), np.float32), 30)
    assert relative_velocity_parts(waving) == {"right arm"}
    gliding = Motion(np.tile(np.eye(3, dtype=np.float32), (30, 24, 1, 1)), np.zeros((30, 3), np.float32), 30)
    assert relative_velocity_parts(gliding) == frozenset()
    with pytest.raises(InvalidInputError, match="share from 0 to 1"):
        relative_velocity_parts(waving, 2.0)
