"""Held poses meet their keypoints, and what is corrected comes and goes without a jump."""

from __future__ import annotations

import numpy as np
import pytest

from motionrt.locomotion.held_points import FADE, hold_points
from motionrt.locomotion.starting_poses import standing as shipped
from motionrt.motion import SMPL24, Motion

FPS = 30.0


def joint(motion: Motion, name: str) -> np.ndarray:
    return motion.positions()[:, SMPL24.index(name)]


@pytest.fixture(scope="module")
def stands() -> Motion:
    pose = shipped()
    assert pose is not None
    return Motion(np.repeat(pose.rotations, 120, axis=0), np.repeat(pose.root, 120, axis=0), FPS)


@pytest.mark.parametrize("name", ["right_hand", "left_wrist", "left_foot", "right_foot", "pelvis"])
def test_the_joint_is_at_its_point_all_the_time_that_the_pose_is_held(stands: Motion, name: str) -> None:
    point = joint(stands, name)[60] + np.array([0.0, -0.03 if name == "pelvis" else 0.05, 0.03])
    held = joint(hold_points(stands, [(40, 80, {name: tuple(point)})]), name)
    assert np.linalg.norm(held[40:80] - point, axis=1).max() < 0.002


def test_a_hand_out_of_reach_draws_the_pelvis_and_not_the_feet(stands: Motion) -> None:
    shoulder = joint(stands, "right_shoulder")[0]
    reach = np.linalg.norm(np.diff(stands.positions()[0, [17, 19, 21, 23]], axis=0), axis=1).sum()
    point = shoulder + (reach + 0.04) * np.array([0.0, -0.5, np.sqrt(0.75)])
    held = hold_points(stands, [(40, 80, {"right_hand": tuple(point)})])
    assert np.linalg.norm(joint(held, "right_hand")[40:80] - point, axis=1).max() < 0.02
    for foot in ("left_ankle", "right_ankle"):
        np.testing.assert_allclose(joint(held, foot), joint(stands, foot), atol=0.003)


def test_nothing_changes_far_from_holds_and_nothing_jumps(stands: Motion) -> None:
    point = joint(stands, "left_foot")[0] + np.array([0.0, 0.0, 0.08])
    held = hold_points(stands, [(40, 80, {"left_foot": tuple(point)})])
    for outside in (slice(0, 40 - FADE), slice(80 + FADE, None)):
        np.testing.assert_allclose(held.positions()[outside], stands.positions()[outside], atol=1e-5)
    assert np.linalg.norm(np.diff(held.positions(), axis=0), axis=-1).max() * FPS < 1.0


def test_a_foot_that_is_moved_is_lifted_and_stays_between_two_holds(stands: Motion) -> None:
    point = joint(stands, "left_foot")[0] + np.array([0.0, 0.0, 0.1])
    holds = [(40, 50, {"left_foot": tuple(point)}), (80, 90, {"left_foot": tuple(point)})]
    way = joint(hold_points(stands, holds), "left_foot")
    assert way[40 - FADE : 40, 1].max() - point[1] > 0.03
    assert np.linalg.norm(way[40:90] - point, axis=1).max() < 0.002


def test_no_hold_no_change(stands: Motion) -> None:
    np.testing.assert_array_equal(hold_points(stands, []).positions(), stands.positions())
