"""Motions drawn in motion space by a tiny denoiser: chance, timelines, constraints, loops, candidates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from tiny_models import TINY_GENERATORS

from motionrt import Runtime
from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.motion.transforms import heading
from motionrt.synthesis.choosing import best
from motionrt.synthesis.constraints import Constraints, Kept, Keyframe, Target, Waypoint
from motionrt.synthesis.motion_generator import between
from motionrt.synthesis.timeline import Line

HOW: dict[str, Any] = {"sampler": "motion", "seed": 7}


@pytest.fixture(scope="module")
def runtime() -> Runtime:
    return Runtime(TINY_GENERATORS, threads=1)


def assert_same(one: Motion, other: Motion) -> None:
    np.testing.assert_array_equal(one.rotations, other.rotations)
    np.testing.assert_array_equal(one.root, other.root)


def test_a_sample_is_the_same_alone_among_others_and_as_a_candidate(runtime: Runtime) -> None:
    many = runtime.generate("walk", n=4, **HOW)
    assert_same(runtime.generate("walk", **HOW), many[0])
    chosen = runtime.generate("walk", candidates=4, **HOW)
    assert any(np.array_equal(chosen.rotations, one.rotations) for one in many)


@pytest.mark.parametrize("seconds", [0.5, 1.0, 3.3, 10.0])
def test_motions_have_the_length_that_was_asked_for(runtime: Runtime, seconds: float) -> None:
    motion = runtime.generate("walk", seconds, **HOW)
    assert motion.fps == 30
    assert motion.frames == round(30 * seconds)


def test_motions_begin_above_the_origin_facing_ahead_with_their_feet_on_the_floor(runtime: Runtime) -> None:
    motion = runtime.generate("walk", **HOW)
    assert motion.root[0, [0, 2]] == pytest.approx(0, abs=1e-5)
    assert heading(motion)[0] == pytest.approx(0, abs=1e-5)
    feet = [SMPL24.index("left_foot"), SMPL24.index("right_foot")]
    assert np.percentile(motion.positions()[:, feet, 1].min(axis=1), 1) == pytest.approx(0, abs=0.01)


def test_splines_pass_through_their_frames_as_scipys_with_the_same_slopes_do() -> None:
    values = np.random.default_rng(0).normal(size=(9, 3))
    slopes = np.gradient(values, axis=0)
    slopes[0], slopes[-1] = (values[1] - values[0]) / 2, (values[-1] - values[-2]) / 2
    times = np.linspace(0, 8, 41)
    assert between(values, times) == pytest.approx(CubicHermiteSpline(np.arange(9), values, slopes)(times), abs=1e-9)


def test_a_timeline_of_half_a_minute_is_one_motion(runtime: Runtime) -> None:
    motion = runtime.generate(timeline=[("walk", 6)] * 5, **HOW)
    assert motion.frames == 900
    steps = np.linalg.norm(np.diff(motion.positions(), axis=0), axis=-1)
    assert steps.max() < 0.2  # nothing jumps where one text passes into the next


def test_a_clip_that_is_kept_stands_in_the_answer_and_the_rest_is_drawn(runtime: Runtime) -> None:
    clip = runtime.generate("walk", 4, sampler="motion", seed=1)
    kept = Constraints(kept=[Kept(clip, frozenset({"left arm", "global", "torso", "left leg", "right leg"}))])
    edited = runtime.generate("wave", 4, constraints=kept, foot_lock=False, **HOW)
    ours, theirs = edited.positions(), clip.positions()
    left, right = SMPL24.index("left_wrist"), SMPL24.index("right_wrist")
    assert np.linalg.norm(ours[:, left] - theirs[:, left], axis=1).mean() < 0.02
    assert np.abs(ours[:, right] - theirs[:, right]).max() > 0.01


def test_a_path_with_headings_is_met_within_the_limits(runtime: Runtime) -> None:
    way = [Waypoint(1.0, (0.2, 0.8)), Waypoint(2.0, (1.0, 1.2), 90.0), Waypoint(4.0, (2.5, 1.2), 90.0)]
    motion = runtime.generate("walk", 4, constraints=Constraints(path=way), **HOW)
    for one in way:
        place = motion.root[round(one.time * 30), [0, 2]]
        assert np.linalg.norm(place - one.place) < 0.03
    assert np.degrees(heading(motion)[-1]) == pytest.approx(90, abs=5)


def test_a_hand_reaches_its_target_within_three_centimetres(runtime: Runtime) -> None:
    way = [Waypoint(2.0, (0.0, 1.8), 0.0)]
    free = runtime.generate("stand", 4, constraints=Constraints(path=way), **HOW)
    wrist = SMPL24.index("right_wrist")
    place = free.positions()[60, wrist] + [0.05, 0.15, 0.1]
    target = Target(2.0, "right_wrist", tuple(float(x) for x in place))
    motion = runtime.generate("stand", 4, constraints=Constraints(path=way, targets=[target]), **HOW)
    assert np.linalg.norm(motion.positions()[60, wrist] - place) < 0.03


def test_a_pose_at_a_time_is_met(runtime: Runtime) -> None:
    pose = runtime.generate("sit", 1, sampler="motion", seed=5)[:1]
    motion = runtime.generate("walk", 3, constraints=Constraints(keyframes=[Keyframe(1.5, pose)]), **HOW)
    own = [p - p[:1] * [1, 0, 1] for p in (motion.positions()[45], pose.positions()[0])]
    turned = [ego77.encode(np.repeat(p[None], 3, axis=0))[0, ego77.JOINTS].reshape(-1, 3) for p in own]
    assert np.linalg.norm(turned[0] - turned[1], axis=1).mean() < 0.03


def test_a_loop_ends_where_it_begins_in_pose_and_speed(runtime: Runtime) -> None:
    motion = runtime.generate("walk", 2, loop=True, in_place=True, **HOW)
    first, last = motion.positions()[0], motion.positions()[-1]
    assert np.abs(first - last).max() < 0.01
    speeds = [motion.positions()[b] - motion.positions()[a] for a, b in ((0, 1), (-2, -1))]
    assert motion.frames == 61
    assert np.linalg.norm(speeds[0] - speeds[1], axis=1).mean() * 30 < 0.5


def test_in_place_keeps_the_pose_and_gives_up_the_way(runtime: Runtime) -> None:
    there, here = (runtime.generate("walk", in_place=place, **HOW) for place in (False, True))
    np.testing.assert_array_equal(there.rotations, here.rotations)
    assert np.linalg.norm(there.root[-1] - there.root[0]) > 1
    assert np.abs(here.root[:, [0, 2]]).max() < 0.1
    np.testing.assert_array_equal(there.root[:, 1], here.root[:, 1])


def test_the_candidate_that_does_what_the_text_says_is_kept() -> None:
    standing = Motion(np.tile(np.eye(3, dtype=np.float32), (60, 24, 1, 1)), np.tile([0, 0.9, 0], (60, 1)), 30.0)
    walking = Motion(standing.rotations, standing.root + np.linspace(0, 3, 60)[:, None] * [0, 0, 1], 30.0)
    line = (Line("walk forward", 0, 2),)
    assert best([standing, walking], line, lambda text, motion: 0.0) == 1
    assert best([standing, standing], line, lambda text, motion: 0.0) == 0


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"candidates": 0}, "candidates"),
        ({"candidates": 65}, "candidates"),
        ({"loop": True, "seconds": 9.9}, "loop"),
        ({"constraints": 3}, "constraints"),
        ({"timeline": [("walk", 2)], "text": "walk"}, "a text or a timeline"),
        ({"text": None}, "a text or a timeline"),
        ({"loop": True, "sampler": "vae"}, "sampler"),
    ],
)
def test_what_cannot_be_is_refused(runtime: Runtime, given: dict[str, Any], what: str) -> None:
    with pytest.raises(InvalidInputError, match=what):
        runtime.generate(**{"text": "walk", **HOW, **given})


@pytest.mark.parametrize(
    "make",
    [
        lambda: Constraints(path=[Waypoint(-1, (0, 0))]),
        lambda: Constraints(path=[Waypoint(1, (float("nan"), 0))]),
        lambda: Constraints(targets=[Target(1, "nose", (0, 0, 0))]),
        lambda: Constraints(keyframes=[Keyframe(1, "pose.bvh")]),  # type: ignore[arg-type]
    ],
)
def test_constraints_that_cannot_be_are_refused(make: Any) -> None:
    with pytest.raises(InvalidInputError):
        make()


def test_a_stream_goes_on_where_it_was_and_takes_a_new_text(runtime: Runtime) -> None:
    stream = runtime.converse("walk", seed=3)
    parts = [next(stream), next(stream)]
    stream.say("wave")
    parts.append(next(stream))
    joints = np.concatenate([part.positions() for part in parts])
    assert len(joints) == 180
    steps = np.linalg.norm(np.diff(joints, axis=0), axis=-1)
    assert steps[59].max() < 2 * np.median(steps.max(axis=1))  # no jump from one step to the next
    assert np.linalg.norm(joints[-1, 0] - joints[0, 0]) > 4  # a stroll of 1 m/s for six seconds
