"""SINC 3.1, steps 2 to 5: which of two motions moves which joint."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24
from motionrt.motion.body_parts import PART_JOINTS, PARTS
from motionrt.motion.features import sinc135
from motionrt.synthesis.composing import Combination, combination, compatible

WALK, BOTH_ARMS = {"left leg", "right leg", "global"}, {"left arm", "right arm"}
RIGHT_ARM = [14, 17, 19, 21, 23]  # by hand, from the order of the joints in docs: collar, shoulder, elbow, wrist, hand
SUPPORT = [0, 1, 2, 4, 5, 7, 8, 10, 11]
TORSO = [3, 6, 9, 12, 15]

part_sets = st.frozensets(st.sampled_from(PARTS))


def from_second(found: Combination) -> list[int]:
    return [int(joint) for joint in np.flatnonzero(found.joints)]


def test_step_2_the_motion_with_fewer_parts_is_b_and_the_second_one_in_a_tie() -> None:
    assert combination(WALK, {"right arm"}).b == 1
    assert combination({"right arm"}, WALK).b == 0
    assert combination({"left arm"}, {"right arm"}).b == 1
    assert combination({"right arm"}, {"left arm"}).b == 1


def test_step_3_a_leg_of_b_takes_both_legs_the_global_orientation_and_the_translation() -> None:
    found = combination({*BOTH_ARMS, "torso"}, {"left leg"})
    assert from_second(found) == SUPPORT
    assert found.translation == 1


def test_step_3_a_global_of_b_does_the_same() -> None:
    found = combination({"global"}, {*BOTH_ARMS, "torso"})
    assert (found.b, found.translation) == (0, 0)
    assert from_second(found) == [joint for joint in range(24) if joint not in SUPPORT]


def test_step_3_without_leg_or_global_in_b_the_support_comes_from_a() -> None:
    found = combination(BOTH_ARMS, {"torso"})
    assert from_second(found) == TORSO
    assert found.translation == 0


def test_step_4_the_rest_comes_from_a_and_the_own_parts_of_b_from_b() -> None:
    found = combination(WALK, {"right arm"})
    assert from_second(found) == RIGHT_ARM
    assert from_second(combination({"right arm"}, WALK)) == [joint for joint in range(24) if joint not in RIGHT_ARM]


def test_step_4_parts_that_neither_needs_come_from_a() -> None:
    found = combination({"left arm", "torso"}, {"global"})  # the right arm is nobody's
    assert found.joints[RIGHT_ARM].tolist() == [0] * 5


@given(part_sets, part_sets)
def test_step_5_the_translation_goes_with_the_pelvis(a: frozenset[str], b: frozenset[str]) -> None:
    found = combination(a, b, override=True)
    assert found.translation == found.joints[0]
    assert (found.features[sinc135.TRAJECTORY] == found.joints[0]).all()
    assert (found.features[sinc135.HEIGHT] == found.joints[0]).all()


@given(part_sets, part_sets)
def test_every_joint_has_one_source_and_b_has_what_it_needs(a: frozenset[str], b: frozenset[str]) -> None:
    found = combination(a, b, override=True)
    assert set(found.joints.tolist()) <= {0, 1}
    assert found.joints.shape == (24,)
    fewer = (a, b)[found.b]
    assert len(fewer) == min(len(a), len(b))
    own = [joint for part in fewer for joint in PART_JOINTS[part]]
    assert (found.joints[own] == found.b).all()
    if fewer & {"left leg", "right leg", "global"}:
        assert (found.joints[SUPPORT] == found.b).all()
    assert len(set(found.joints[SUPPORT].tolist())) == 1  # feet never leave their pelvis


@given(part_sets, part_sets)
def test_the_order_only_decides_ties(a: frozenset[str], b: frozenset[str]) -> None:
    there, back = combination(a, b, override=True), combination(b, a, override=True)
    if len(a) != len(b):
        assert (there.joints == 1 - back.joints).all()
        assert there.translation == 1 - back.translation
    else:
        assert there.b == back.b == 1


@given(part_sets, part_sets)
def test_compatible_actions_keep_all_their_parts(a: frozenset[str], b: frozenset[str]) -> None:
    assert compatible(a, b) == compatible(b, a)
    if compatible(a, b):
        found = combination(a, b)
        for source, parts in enumerate((a, b)):
            assert (found.joints[[joint for part in parts for joint in PART_JOINTS[part]]] == source).all()


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        (WALK, BOTH_ARMS, True),
        (WALK, {"torso", "right arm"}, True),
        ({"right arm"}, {"left arm"}, True),
        ({"right arm"}, BOTH_ARMS, False),  # a part in common
        ({"left leg"}, {"right leg"}, False),  # both legs come from one motion
        ({"left leg"}, {"global"}, False),
        ({"torso", "left leg"}, {"left arm", "global"}, False),
        ({"torso"}, set(), False),  # nothing to see of the second
    ],
)
def test_what_is_compatible(a: set[str], b: set[str], expected: bool) -> None:
    assert compatible(a, b) is expected


def test_what_clashes_is_refused_unless_overridden_and_then_goes_to_b() -> None:
    with pytest.raises(InvalidInputError, match="both motions need right arm; override=True"):
        combination(BOTH_ARMS, {"right arm"})
    assert from_second(combination(BOTH_ARMS, {"right arm"}, override=True)) == RIGHT_ARM


def test_an_unknown_part_is_named() -> None:
    with pytest.raises(InvalidInputError, match="tail"):
        combination(WALK, {"tail"})


def test_arrays_are_combined_and_trimmed_to_the_shorter_step_1() -> None:
    first, second = random_motion(7, seed=1), random_motion(5, seed=2)
    rotations, root = combination(WALK, {"right arm"}).apply(
        (first.rotations, first.root), (second.rotations, second.root)
    )
    assert rotations.shape == (5, 24, 3, 3)
    assert np.array_equal(rotations[:, RIGHT_ARM], second.rotations[:, RIGHT_ARM])
    others = [joint for joint in range(24) if joint not in RIGHT_ARM]
    assert np.array_equal(rotations[:, others], first.rotations[:5, others])
    assert np.array_equal(root, first.root[:5])


@given(part_sets, part_sets)
def test_features_are_combined_as_the_motions_are(a: frozenset[str], b: frozenset[str]) -> None:
    first, second = random_motion(6, seed=3), random_motion(4, seed=4)
    found = combination(a, b, override=True)
    rotations, root = found.apply((first.rotations, first.root), (second.rotations, second.root))
    features = found.apply_features(sinc135.encode(first), sinc135.encode(second))
    back = sinc135.decode(features)
    assert features.shape == (4, 135)
    assert np.abs(back.rotations[:, :22] - rotations[:, :22]).max() < 1e-6
    assert np.array_equal(back.root, root)


def test_features_of_a_batch_and_wrong_widths() -> None:
    found = combination(WALK, {"right arm"})
    first, second = np.zeros((3, 8, 135), np.float32), np.ones((3, 6, 135), np.float32)
    combined = found.apply_features(first, second)
    assert combined.shape == (3, 6, 135)
    assert combined.sum() == 3 * 6 * 6 * 4  # four of the right arm's five joints are described: the hand is not
    with pytest.raises(InvalidInputError, match="sinc135"):
        found.apply_features(first, np.zeros((6, 219)))


def test_the_joints_of_the_hand_worked_lists_are_the_parts() -> None:
    assert [SMPL24.names[joint] for joint in RIGHT_ARM] == [
        f"right_{name}" for name in ("collar", "shoulder", "elbow", "wrist", "hand")
    ]
    assert [SMPL24.names[joint] for joint in TORSO] == ["spine1", "spine2", "spine3", "neck", "head"]
