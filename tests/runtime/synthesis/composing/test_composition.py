"""``compose``: exact copies outside the seam, rotations at it, masks, leans and floors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from gaits import gait
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation, Slerp

from motionrt.metrics import foot_skate
from motionrt.motion import SMPL24, Motion
from motionrt.motion.body_parts import PARTS
from motionrt.motion.transforms import floor_height
from motionrt.synthesis.composing import Layer, combination, compose
from motionrt.synthesis.composing.posture import lean

WALK, ARMS = ("left leg", "right leg", "global"), ("left arm", "right arm")
UPPER = ("torso", *ARMS)
SEAM = [SMPL24.index(name) for name in ("spine1", "spine2", "spine3", "left_collar", "right_collar")]
REST = [joint for joint in range(24) if joint not in SEAM]
RIGHT_ARM = [14, 17, 19, 21, 23]

part_sets = st.frozensets(st.sampled_from(PARTS))


def bent(frames: int, joint: str, degrees: float, axis: int = 0, height: float = 0.95) -> Motion:
    """The rest pose with one joint turned."""
    rotations = np.tile(np.eye(3, dtype=np.float32), (frames, 24, 1, 1))
    turn = Rotation.from_rotvec(np.eye(3)[axis] * degrees, degrees=True).as_matrix()
    rotations[:, SMPL24.index(joint)] = turn
    return Motion(rotations, np.tile(np.array([0, height, 0], np.float32), (frames, 1)), 30)


def same(a: Motion, b: Motion) -> bool:
    return np.array_equal(a.rotations, b.rotations) and np.array_equal(a.root, b.root) and a.fps == b.fps


@given(part_sets, part_sets)
def test_two_layers_are_the_papers_combination_bit_for_bit(a: frozenset[str], b: frozenset[str]) -> None:
    first, second = random_motion(6, seed=1), random_motion(4, seed=2)
    rotations, root = combination(a, b, override=True).apply(
        (first.rotations, first.root), (second.rotations, second.root)
    )
    layers = [Layer(first, a), Layer(second, b)]
    hard, soft = compose(layers, seam=0), compose(layers)
    assert np.array_equal(hard.rotations, rotations)
    assert np.array_equal(hard.root, root)
    assert np.array_equal(soft.rotations[:, REST], rotations[:, REST])
    assert np.array_equal(soft.root, root)


@pytest.mark.parametrize("seam", [0, 1, 2, 3])
@pytest.mark.parametrize("keep", ["local", "world"])
@pytest.mark.parametrize("align", ["start", "stretch", "phase"])
def test_a_motion_composed_with_itself_is_itself(seam: int, keep: str, align: str) -> None:
    motion = walking(60)
    found = compose([Layer(motion, WALK), Layer(motion, UPPER)], seam=seam, keep=keep, align=align)  # type: ignore[arg-type]
    assert np.abs(found.rotations - motion.rotations).max() < 1e-6
    assert np.array_equal(found.root, motion.root)
    if align != "phase":  # which reads at times that are whole frames up to rounding
        assert same(found, motion)


def test_the_order_of_layers_does_not_matter_without_a_tie() -> None:
    legs, arm, torso = (random_motion(9, seed=n) for n in range(3))
    layers = [Layer(legs, WALK), Layer(torso, ("torso", "left arm")), Layer(arm, "right arm")]
    expected = compose(layers, seam=2)
    for order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
        assert same(compose([layers[n] for n in order], seam=2), expected)


def test_three_actions_share_one_body() -> None:
    legs, left, right = (random_motion(9, seed=n) for n in range(3))
    found = compose([Layer(legs, WALK), Layer(left, "left arm"), Layer(right, "right arm")], seam=0)
    assert np.array_equal(found.rotations[:, RIGHT_ARM], right.rotations[:, RIGHT_ARM])
    assert np.array_equal(found.rotations[:, [13, 16, 18]], left.rotations[:, [13, 16, 18]])
    assert np.array_equal(found.rotations[:, :13], legs.rotations[:, :13])


def test_a_base_without_parts_moves_what_the_others_leave() -> None:
    base, arm = random_motion(9, seed=1), random_motion(9, seed=2)
    found = compose([base, Layer(arm, "right arm")], seam=0)
    assert np.array_equal(found.rotations[:, RIGHT_ARM], arm.rotations[:, RIGHT_ARM])
    others = [joint for joint in range(24) if joint not in RIGHT_ARM]
    assert np.array_equal(found.rotations[:, others], base.rotations[:, others])


def test_a_mask_moves_its_joints_and_no_others() -> None:
    base, other = random_motion(9, seed=1), random_motion(9, seed=2)
    found = compose([base, Layer(other, mask=["right_wrist", "head"])])
    assert np.array_equal(found.rotations[:, [21, 15]], other.rotations[:, [21, 15]])
    others = [joint for joint in range(24) if joint not in (21, 15)]
    assert np.array_equal(found.rotations[:, others], base.rotations[:, others])
    assert np.array_equal(found.root, base.root)


def test_the_later_of_two_overlapping_masks_wins() -> None:
    base, first, second = (random_motion(9, seed=n) for n in range(3))
    found = compose([base, Layer(first, mask="right arm"), Layer(second, mask="right_wrist")], seam=0)
    assert np.array_equal(found.rotations[:, 21], second.rotations[:, 21])
    assert np.array_equal(found.rotations[:, 19], first.rotations[:, 19])


def test_the_translation_comes_with_the_mask_that_has_the_pelvis() -> None:
    base, other = random_motion(9, seed=1), random_motion(9, seed=2)
    found = compose([base, Layer(other, mask=WALK)], seam=0)
    assert np.array_equal(found.root, other.root)


def test_parts_are_derived_where_none_are_given() -> None:
    base, arm = random_motion(9, seed=1), random_motion(9, seed=2)
    found = compose([base, arm], seam=0, derive=lambda motion: WALK if motion.root[0, 0] == base.root[0, 0] else ARMS)
    assert same(found, compose([Layer(base, WALK), Layer(arm, ARMS)], seam=0))


def test_a_first_motion_keeps_its_legs_and_its_way_unless_told_otherwise() -> None:
    base, other = random_motion(9, seed=1), random_motion(9, seed=2)
    found = compose([base, other], seam=0, derive=lambda _: (*WALK, "left arm"))
    assert same(found, compose([Layer(base, PARTS), Layer(other, "left arm")], seam=0))
    assert np.array_equal(found.root, base.root)
    upper = compose([base, other], seam=0, derive=lambda _: WALK)
    assert same(upper, compose([Layer(base, PARTS), Layer(other, UPPER)], seam=0))
    told = compose([base, Layer(other, WALK)], seam=0, derive=lambda _: ARMS)
    assert np.array_equal(told.root, other.root)


@pytest.mark.parametrize(("seam", "shares"), [(1, [1 / 2, 1, 1]), (2, [1 / 3, 2 / 3, 1]), (3, [1 / 4, 1 / 2, 3 / 4])])
def test_the_seam_is_a_slerp_up_the_spine(seam: int, shares: list[float]) -> None:
    below, above = random_motion(5, seed=1), random_motion(5, seed=2)
    found = compose([Layer(below, WALK), Layer(above, UPPER)], seam=seam)
    for joint, share in zip((3, 6, 9), shares, strict=True):
        for frame in range(5):
            ends = Rotation.from_matrix(np.stack([below.rotations[frame, joint], above.rotations[frame, joint]]))
            expected = Slerp([0, 1], ends)(share).as_matrix()
            assert np.abs(found.rotations[frame, joint] - expected).max() < 2e-6


def test_a_seam_at_the_arm_takes_half_of_the_collar_whatever_its_width() -> None:
    base, arm = bent(3, "pelvis", 0), bent(3, "right_collar", 40, axis=2)
    for seam in (1, 2, 3):
        found = compose([base, Layer(arm, "right arm")], seam=seam)
        angle = Rotation.from_matrix(found.rotations[:, 14]).magnitude()
        assert np.degrees(angle) == pytest.approx([20] * 3, abs=1e-3)


@given(st.integers(0, 3), st.floats(0, 1), part_sets, st.sampled_from(["local", "world"]))
def test_all_that_comes_out_is_a_rotation(seam: int, weight: float, parts: frozenset[str], keep: str) -> None:
    layers = [random_motion(4, seed=1), Layer(random_motion(4, seed=2), parts, weight=weight)]
    matrices = compose(layers, seam=seam, keep=keep).rotations.astype(np.float64)  # type: ignore[arg-type]
    assert np.abs(matrices @ np.swapaxes(matrices, -1, -2) - np.eye(3)).max() < 1e-5
    assert np.abs(np.linalg.det(matrices) - 1).max() < 1e-5


def test_a_layers_weight_is_a_share_of_its_turn() -> None:
    found = compose([bent(3, "pelvis", 0), Layer(bent(3, "right_elbow", 80), mask="right arm", weight=0.25)])
    assert np.degrees(Rotation.from_matrix(found.rotations[:, 19]).magnitude()) == pytest.approx([20] * 3, abs=1e-3)


def test_lean_is_what_is_left_without_the_turn_about_the_vertical() -> None:
    turn, tilt = Rotation.from_euler("y", 70, degrees=True), Rotation.from_rotvec([0.4, 0, -0.2])
    assert np.abs(lean((turn * tilt).as_matrix()) - tilt.as_matrix()).max() < 1e-7


@pytest.mark.parametrize("seam", [0, 1])
def test_a_torso_kept_in_the_world_stays_upright_on_hips_that_lean(seam: int) -> None:
    leaning, upright = bent(4, "pelvis", 30), bent(4, "pelvis", 90, axis=1)  # the donor looks another way, too
    layers = [Layer(leaning, WALK), Layer(upright, UPPER)]
    copied, kept = (compose(layers, seam=seam, keep=keep).global_rotations()[:, 15] for keep in ("local", "world"))
    assert np.degrees(np.arccos(copied[:, 1, 1])) == pytest.approx([30] * 4, abs=0.01)
    assert kept[:, 1, 1] == pytest.approx([1] * 4, abs=1e-5)  # upright
    assert kept[:, 2, 2] == pytest.approx([1] * 4, abs=1e-5)  # and facing where the hips face


def test_a_torso_kept_in_the_world_leans_as_its_donor_leans() -> None:
    leaning, donor = bent(4, "pelvis", 30), bent(4, "pelvis", 0)
    rotations = donor.rotations.copy()
    tilt = Rotation.from_euler("x", -20, degrees=True)
    rotations[:, 0] = (Rotation.from_euler("y", 50, degrees=True) * tilt).as_matrix()
    found = compose([Layer(leaning, WALK), Layer(replace(donor, rotations=rotations), UPPER)], keep="world")
    assert np.abs(found.global_rotations()[:, 15] - tilt.as_matrix()).max() < 1e-5


def test_feet_that_come_without_their_pelvis_stay_on_the_ground() -> None:
    crouching = bent(20, "left_hip", 0, height=0.6)  # its own feet would be under the floor
    walk = walking(20, fps=30)
    found = compose([crouching, Layer(walk, mask=["left leg", "right leg"])])
    toes = [10, 11]
    assert found.positions()[:, toes, 1].min(axis=1) == pytest.approx(
        walk.positions()[:, toes, 1].min(axis=1), abs=1e-5
    )


def test_locked_feet_slide_less_than_legs_on_a_foreign_pelvis() -> None:
    walk, slide = gait(seconds=3)[0], gait(seconds=3, speed=0.75)[0]
    layers = [slide, Layer(walk, mask=["left leg", "right leg"])]
    free, locked = compose(layers), compose(layers, foot_lock=True)
    assert foot_skate(locked.positions()) < 0.7 * foot_skate(free.positions())
    assert abs(floor_height(locked)) < 0.02
    assert np.array_equal(free.rotations[:, 12:], locked.rotations[:, 12:])


def test_a_single_frame_is_a_pose_that_is_held() -> None:
    walk, pose = walking(30), bent(1, "right_shoulder", 90, axis=2)
    found = compose([walk, Layer(pose, "right arm")])
    assert found.frames == 30
    assert np.array_equal(found.rotations[:, 17], np.repeat(pose.rotations[:, 17], 30, axis=0))
    assert compose([standing(1), Layer(pose, "right arm")]).frames == 1
    assert compose([standing(1), Layer(pose, "right arm")], seconds=2).frames == 40
