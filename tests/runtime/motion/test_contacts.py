"""Foot contacts of gaits whose contacts are known."""

from __future__ import annotations

import numpy as np
import pytest
from gaits import gait
from motions import random_motion, standing

from motionrt.motion import Motion
from motionrt.motion.feet.contacts import foot_contacts, hysteresis, joint_contacts, stretches, toe_contacts
from motionrt.motion.transforms import moved


@pytest.mark.parametrize("fps", [20, 25, 30, 60, 120])
def test_the_contacts_of_a_known_gait_are_found_at_any_rate(fps: float) -> None:
    motion, known = gait(fps=fps)
    found = foot_contacts(motion)
    assert (found >= known).all()
    for foot in range(2):
        runs, true = stretches(found[:, foot]), stretches(known[:, foot])
        assert len(runs) == len(true)
        ends = np.abs(np.array(runs) - np.array(true))
        assert ends.max() <= max(2, 0.06 * fps)  # a foot leaves and arrives slowly


def test_a_foot_in_the_air_is_no_contact_however_still() -> None:
    still = standing(30)
    assert foot_contacts(still).all()
    assert not foot_contacts(moved(still, np.array([0, 0.2, 0]))).any()
    assert foot_contacts(moved(still, np.array([0, 0.2, 0])), floor=0.2).all()


def test_a_fast_foot_on_the_floor_is_no_contact() -> None:
    still = standing(30, fps=30)
    root = still.root + np.outer(np.arange(30) / 30, [2.0, 0, 0]).astype(np.float32)
    assert not foot_contacts(Motion(still.rotations, root, 30)).any()


def test_a_foot_on_its_heel_stands_but_its_toe_does_not() -> None:
    still = standing(40, fps=30)
    turn = np.deg2rad(-40 * np.abs(np.sin(np.arange(40) * 0.6)))  # the left foot taps about its ankle
    rotations = still.rotations.copy()
    rotations[:, 7, 1, 1] = rotations[:, 7, 2, 2] = np.cos(turn)
    rotations[:, 7, 2, 1], rotations[:, 7, 1, 2] = np.sin(turn), -np.sin(turn)
    tapping = Motion(rotations, still.root, 30)
    assert foot_contacts(tapping).all()
    assert not toe_contacts(tapping)[:, 0].all()
    assert toe_contacts(tapping)[:, 1].all()


def test_one_frame_off_the_floor_and_one_frame_on_it_are_flickers() -> None:
    still = standing(30, fps=30)
    root = still.root.copy()
    root[:10, 1] += 0.5
    root[20, 1] += 0.1  # one frame: 1.5 m/s by central differences in the frames beside it
    root[5, 1] -= 0.5
    found = toe_contacts(Motion(still.rotations, root, 120))
    assert len(stretches(found[:, 0])) == 1
    assert not found[:6].any()
    assert found[18:].all()


def test_hysteresis_keeps_the_loose_stretches_that_hold_a_strict_frame() -> None:
    loose = np.array([1, 1, 0, 1, 1, 1, 0, 1], bool)[:, None]
    strict = np.array([0, 0, 0, 0, 1, 0, 0, 0], bool)[:, None]
    assert hysteresis(strict, loose)[:, 0].astype(int).tolist() == [0, 0, 0, 1, 1, 1, 0, 0]


def test_contacts_of_the_mirrored_and_of_the_reversed_motion_are_mirrored_and_reversed() -> None:
    motion, _ = gait(slide=0.2)
    found = joint_contacts(motion)
    np.testing.assert_array_equal(joint_contacts(motion.mirror()), found[:, [2, 3, 0, 1]])
    backwards = Motion(motion.rotations[::-1], motion.root[::-1], motion.fps)
    np.testing.assert_array_equal(joint_contacts(backwards), found[::-1])


def test_a_single_frame_has_contacts() -> None:
    assert foot_contacts(standing(1)).tolist() == [[True, True]]
    assert foot_contacts(random_motion(1, root=(0, 5, 0))).tolist() == [[False, False]]
