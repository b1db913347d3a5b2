"""What a performance begins with: standing, a stride, and held poses that breathe."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels
from motions import random_motion, standing

from motionrt.errors import InvalidInputError
from motionrt.formats.motion_pack import MotionPack
from motionrt.locomotion import starting_poses as poses
from motionrt.locomotion.bearings import facing_of, over_feet, place_of
from motionrt.locomotion.holding import hold
from motionrt.motion import SMPL24

POSE = random_motion(1, FPS)


def test_a_hold_begins_and_ends_in_its_pose_and_lasts_as_asked() -> None:
    held = hold(POSE, 4.0, seed=1)
    assert held.frames == 120
    for frame in (held[:1], held[-1:]):
        np.testing.assert_allclose(frame.positions(), POSE.positions(), atol=1e-3)
    assert np.abs(np.diff(held.positions(), axis=0)).max() < 0.005


def test_a_held_pose_breathes_but_its_feet_and_pelvis_do_not_move() -> None:
    positions = hold(POSE, 4.0, seed=1).positions()
    legs = [SMPL24.index(name) for name in ("pelvis", "left_foot", "right_foot", "left_knee", "right_hip")]
    np.testing.assert_allclose(positions[:, legs], np.tile(POSE.positions()[:, legs], (120, 1, 1)), atol=1e-6)
    hand = np.linalg.norm(
        positions[:, SMPL24.index("left_hand")] - POSE.positions()[0, SMPL24.index("left_hand")], axis=1
    )
    assert 0.001 < hand.max() < 0.015


def test_holds_differ_by_their_seed_alone() -> None:
    np.testing.assert_array_equal(hold(POSE, 1, 5).rotations, hold(POSE, 1, 5).rotations)
    assert not np.array_equal(hold(POSE, 1, 5).rotations, hold(POSE, 1, 6).rotations)


@pytest.mark.parametrize(("frames", "seconds"), [(2, 1.0), (1, -1.0), (1, float("nan"))])
def test_a_hold_of_nothing_is_refused(frames: int, seconds: float) -> None:
    with pytest.raises(InvalidInputError, match="hold one frame"):
        hold(random_motion(frames), seconds)


def test_the_stand_in_stride_walks_along_z_at_walking_speed_on_the_ground() -> None:
    stride = poses.stride_of(poses.plain_stride())
    assert stride.frames >= 30
    assert place_of(stride) == pytest.approx((0, 0), abs=1e-6)
    assert facing_of(stride) == pytest.approx(0, abs=1e-5)
    assert (stride.root[-1, 2] - stride.root[0, 2]) / (stride.frames - 1) * FPS == pytest.approx(1.2, abs=0.01)
    toes = stride.positions()[:, [10, 11], 1]
    assert toes.min() == pytest.approx(0, abs=0.02)


def test_stride_and_standing_come_from_the_asset(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "stride.npz"
    monkeypatch.setattr(poses, "STRIDE_FILE", file)
    assert poses.standing() is None
    np.testing.assert_array_equal(poses.stride().root, poses.stride_of(poses.plain_stride()).root)
    walk, stand = random_motion(40, FPS, root=(3, 0.9, 2)), standing(1, FPS)
    with file.open("wb") as stream:
        MotionPack.of([walk, stand]).write(stream)
    np.testing.assert_allclose(poses.stride().root, poses.stride_of(walk).root, atol=1e-3)
    found = poses.standing()
    assert found is not None
    np.testing.assert_allclose(found.positions(), standing(1, FPS).positions(), atol=1e-3)


def test_somebody_who_stands_is_over_their_feet() -> None:
    assert over_feet(FakeCharacterModels().standing) == pytest.approx((0, 0), abs=0.08)
