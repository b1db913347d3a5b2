"""Egocentric frames: there and back, mirror images, independence of where and which way a motion goes."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from motions import random_motion, walking
from scipy.spatial.transform import Rotation

from motionrt.motion import transforms
from motionrt.motion.features import sinc135
from motionrt_training.networks import egocentric
from motionrt_training.networks.egocentric import from_egocentric, to_egocentric
from motionrt_training.networks.kinematics import joint_positions


def raw(motion: object) -> torch.Tensor:
    return torch.from_numpy(sinc135.encode(motion))[None]  # type: ignore[arg-type]


@settings(max_examples=20, deadline=None)
@given(yaw=st.floats(-3.0, 3.0), x=st.floats(-5.0, 5.0), z=st.floats(-5.0, 5.0))
def test_a_walk_looks_the_same_wherever_it_goes(yaw: float, x: float, z: float) -> None:
    motion = walking(40, 30.0, turn=0.5)
    elsewhere = transforms.moved(transforms.turned(motion, yaw), np.array([x, 0.0, z]))
    assert torch.allclose(to_egocentric(raw(elsewhere)), to_egocentric(raw(motion)), atol=2e-5)


def test_there_and_back_is_the_same_motion_seen_from_its_start() -> None:
    motion = random_motion(50, 30.0, seed=3)
    back = sinc135.decode(from_egocentric(to_egocentric(raw(motion)))[0].numpy())
    first = motion.rotations[0, 0, :, 0]
    upright = transforms.turned(motion, -float(np.arctan2(-first[2], first[0])))
    expected = transforms.moved(upright, -upright.root[0] * [1, 0, 1])
    joints = slice(0, 22)  # hands are not described
    np.testing.assert_allclose(back.positions()[:, joints], expected.positions()[:, joints], atol=1e-4)


def test_the_mirror_image_of_the_frames_is_that_of_the_motion() -> None:
    motion = random_motion(20, 30.0, seed=5)
    expected = to_egocentric(raw(motion.mirror()))
    assert torch.allclose(egocentric.mirrored(to_egocentric(raw(motion))), expected, atol=1e-5)


def test_a_known_walk_has_known_rates() -> None:
    frames = to_egocentric(raw(walking(30, 30.0, speed=1.2, turn=0.6)))[0]
    assert frames[:-1, 0].numpy() == pytest.approx(0.6 / 30.0, abs=1e-6)
    assert frames[:-1, 1:3].norm(dim=1).numpy() == pytest.approx(1.2 / 30.0, abs=1e-6)
    assert (frames[-1, :3] == 0).all()


def test_rotations_are_orthonormal_and_without_heading() -> None:
    motion = random_motion(10, 30.0, seed=1)
    found = egocentric.rotations(to_egocentric(raw(motion)))[0]
    turn = Rotation.from_matrix(found[:, 0].numpy())
    assert np.abs(turn.as_matrix()[:, 2, 0]).max() < 1e-5  # the left axis has no part along Z
    np.testing.assert_allclose(found[:, 1:22].numpy(), motion.rotations[:, 1:22], atol=1e-5)
    assert joint_positions(found).shape == (10, 24, 3)
