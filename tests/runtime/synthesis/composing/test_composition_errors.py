"""What ``compose`` refuses, and that it says why."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from motions import random_motion, standing, walking

from motionrt.errors import InvalidInputError
from motionrt.motion import SMPL24, Motion, Skeleton
from motionrt.synthesis.composing import Layer, compose

MOTION = random_motion(8)


@pytest.mark.parametrize("layers", [[], [MOTION], [Layer(MOTION, "torso")]])
def test_fewer_than_two_layers(layers: list[Any]) -> None:
    with pytest.raises(InvalidInputError, match="two motions or more"):
        compose(layers)


def test_something_else_than_a_motion() -> None:
    with pytest.raises(InvalidInputError, match="layer 1 is a str"):
        compose([MOTION, "wave"])  # type: ignore[list-item]


@pytest.mark.parametrize("given", [{"parts": "tail"}, {"parts": ["left arm", "tail"]}, {"mask": ["torso", "tail"]}])
def test_an_unknown_part_or_joint(given: dict[str, Any]) -> None:
    with pytest.raises(InvalidInputError, match=r"'tail'.*left arm"):
        Layer(MOTION, **given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"mask": []}, "at least one part or joint"),
        ({"parts": "torso", "mask": "torso"}, "not both"),
        ({"parts": "torso", "weight": 1.5}, "weight must be from 0 to 1"),
        ({"parts": "torso", "weight": float("nan")}, "weight must be from 0 to 1"),
    ],
)
def test_a_layer_that_means_nothing(given: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        Layer(MOTION, **given)


def test_another_skeleton_and_how_to_leave_it() -> None:
    own = Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets * 1.1)
    with pytest.raises(InvalidInputError, match=r"layer 1 has a skeleton of its own.*to_smpl24"):
        compose([MOTION, Layer(replace(MOTION, skeleton=own), "torso")])


def test_layers_that_do_not_say_what_they_move() -> None:
    with pytest.raises(InvalidInputError, match="layer 1 has neither parts nor a mask"):
        compose([MOTION, MOTION])
    with pytest.raises(InvalidInputError, match="layer 1 has neither parts nor a mask"):
        compose([Layer(MOTION, "torso"), MOTION])


@pytest.mark.parametrize("seconds", [0, -1, 10_000, float("nan"), float("inf")])
def test_seconds_out_of_range(seconds: float) -> None:
    with pytest.raises(InvalidInputError, match="seconds must be a number above 0 and at most 600"):
        compose([MOTION, Layer(MOTION, "torso")], seconds=seconds)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"seam": 4}, "seam must be"),
        ({"seam": 0.5}, "seam must be"),
        ({"seam": True}, "seam must be"),
        ({"align": "beat"}, "align must be one of start, stretch, phase"),
        ({"keep": "global"}, "keep must be"),
    ],
)
def test_unknown_options(options: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        compose([MOTION, Layer(MOTION, "torso")], **options)


def test_clashes_where_no_override_is_wanted() -> None:
    legs = [Layer(MOTION, "left leg"), Layer(MOTION, "global")]
    with pytest.raises(InvalidInputError, match="layers 0 and 1 both need global, left leg, right leg"):
        compose(legs, override=False)
    masks = [MOTION, Layer(MOTION, mask="right arm"), Layer(MOTION, mask="right_wrist")]
    with pytest.raises(InvalidInputError, match="masks of layers 1 and 2 both have right_wrist"):
        compose(masks, override=False)
    assert compose([MOTION, Layer(MOTION, "right arm")], override=False).frames == 8  # the base takes the rest


def test_a_phase_that_is_not_there() -> None:
    still = standing(60)
    with pytest.raises(InvalidInputError, match='align="phase" needs two motions'):
        compose([walking(60), Layer(still, "torso")], align="phase")
    with pytest.raises(InvalidInputError, match='align="phase" needs two motions'):
        compose([still, Layer(walking(60), "torso")], align="phase")


def test_other_frame_rates_are_resampled_to_the_first_ones() -> None:
    slow, fast = random_motion(20, fps=20, seed=1), random_motion(60, fps=60, seed=2)
    found = compose([slow, Layer(fast, "right arm")], seam=0)
    assert found.fps == 20
    assert found.frames == 20
    assert np.array_equal(found.rotations[:, 21], fast.rotations[::3, 21])


def test_the_layers_stay_as_they_were() -> None:
    base, arm = random_motion(20, seed=1), random_motion(10, seed=2)
    before = base.rotations.copy(), arm.rotations.copy()
    compose([base, Layer(arm, "right arm")], seconds=3, keep="world", foot_lock=True)
    assert isinstance(base, Motion)
    assert np.array_equal(base.rotations, before[0])
    assert np.array_equal(arm.rotations, before[1])


@pytest.mark.parametrize("wrong", [{"parts": 5}, {"mask": 5}, {"weight": "much"}, {"motion": "walk.bvh"}])
def test_a_layer_of_the_wrong_kind(wrong: dict[str, Any]) -> None:
    with pytest.raises(InvalidInputError, match=r"list of names|weight|needs a Motion"):
        Layer(**{"motion": MOTION, **wrong})


def test_no_list_and_no_number() -> None:
    with pytest.raises(InvalidInputError, match="two motions or more"):
        compose(None)  # type: ignore[arg-type]
    with pytest.raises(InvalidInputError, match="seconds must be a number above 0"):
        compose([MOTION, Layer(MOTION, "torso")], seconds="long")  # type: ignore[arg-type]
