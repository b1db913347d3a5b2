"""Chained actions: no gaps, no jumps, at the right places, and errors that name the step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels, stays
from motions import walking

from motionrt.errors import InvalidInputError, PathError, ReachError, WalkError
from motionrt.locomotion import (
    Act,
    Do,
    Follow,
    Generate,
    Goal,
    Pace,
    Path,
    Performance,
    Scene,
    SemanticCloud,
    Stand,
    Wait,
    WalkTo,
)
from motionrt.locomotion.actions import Action
from motionrt.locomotion.bearings import facing_of
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.starting_poses import stride_of
from motionrt.motion import Motion

SIT = Act({"pelvis": (0.0, 0.55, 11.0)}, heading=np.pi, approach=(0.0, 10.6), name="sit")
HIGH = Act({"right_hand": (4.0, 1.2, 3.0)}, heading=0.0, name="grab high", hold_s=1.0)
LOW = Act({"right_hand": (4.0, 0.6, 3.0)}, heading=0.0, name="grab low", hold_s=1.0)
SCENE = [WalkTo(0, 8), SIT, Stand(), WalkTo(4, 2), HIGH, LOW, WalkTo(9, 9)]


def perform(actions: Sequence[Action], start: Goal | None = None, **options: object) -> Performance:
    performer = Performer(FakeCharacterModels(), start or Goal(0, 0), **options)
    return performer.perform(actions, foot_lock=False)


@pytest.fixture(scope="module")
def performance() -> Performance:
    return perform(SCENE)


def kinds(performance: Performance) -> list[str]:
    return [segment.kind for segment in performance.segments]


def test_the_segments_tile_the_motion(performance: Performance) -> None:
    edges = [0, *[segment.end for segment in performance.segments]]
    assert [segment.start for segment in performance.segments] == edges[:-1]
    assert edges[-1] == performance.motion.frames
    assert all(segment.frames > 0 for segment in performance.segments)


def test_the_root_never_jumps(performance: Performance) -> None:
    steps = np.linalg.norm(np.diff(performance.motion.root, axis=0), axis=1)
    assert steps.max() < 0.1
    assert performance.measures.largest_step_cm == pytest.approx(100 * steps.max(), rel=1e-5)


def test_every_step_is_in_the_timeline_in_order(performance: Performance) -> None:
    names = [segment.name for segment in performance.segments]
    seen = list(dict.fromkeys(names))
    assert seen == [
        "start",
        "walk to 0.0, 8.0",
        "sit",
        "stand",
        "walk to 4.0, 2.0",
        "grab high",
        "grab low",
        "walk to 9.0, 9.0",
    ]


def test_held_poses_meet_their_keypoints_for_as_long_as_asked(performance: Performance) -> None:
    holds = {segment.name: segment for segment in performance.segments if segment.kind == "hold"}
    assert holds["sit"].frames == 2 * FPS
    assert holds["grab high"].frames == FPS
    assert holds["sit"].miss_cm["pelvis"] < 0.01
    for name in ("grab high", "grab low"):
        assert holds[name].miss_cm["right_hand"] < 1.0  # the chest breathes
        middle = (holds[name].start + holds[name].end) // 2
        hand = performance.motion.positions()[middle, 23]
        np.testing.assert_allclose(hand, holds[name].keypoints["right_hand"], atol=0.01)
    assert performance.measures.keypoint_max_cm is not None
    assert performance.measures.keypoint_max_cm < 1.0


def test_two_acts_in_one_place_follow_each_other_without_a_walk(performance: Performance) -> None:
    first = next(i for i, s in enumerate(performance.segments) if s.name == "grab high" and s.kind == "hold")
    assert [(s.kind, s.name) for s in performance.segments[first + 1 : first + 3]] == [
        ("transition", "grab low"),
        ("hold", "grab low"),
    ]


def test_transitions_end_in_their_poses_and_walks_keep_to_their_paths(performance: Performance) -> None:
    for segment in performance.segments:
        if segment.kind == "transition":
            assert segment.end_cm is None or segment.end_cm == pytest.approx(0.0, abs=0.01)
        if segment.kind == "walk":
            assert segment.off_path_m == pytest.approx(0.0, abs=0.02)
    assert len(performance.paths) == kinds(performance).count("walk") > 2


def test_it_stands_at_the_end_of_a_walk_and_faces_where_it_came_to(performance: Performance) -> None:
    np.testing.assert_allclose(performance.motion.root[-1, [0, 2]], [9, 9], atol=1e-4)
    start = performance.motion.root[performance.segments[-2].start]
    assert facing_of(performance.motion) == pytest.approx(np.arctan2(9 - start[0], 9 - start[2]), abs=0.2)


def test_a_heading_to_end_with_is_turned_to() -> None:
    done = perform([WalkTo(0, 6, heading=-np.pi / 2)])
    assert facing_of(done.motion) == pytest.approx(-np.pi / 2, abs=1e-3)
    about = perform([WalkTo(0, 6, heading=np.pi)])
    assert abs(facing_of(about.motion)) == pytest.approx(np.pi, abs=1e-3)
    assert kinds(about) == kinds(done)


def test_walks_in_a_row_do_not_stop_between() -> None:
    done = perform([WalkTo(0, 6), WalkTo(6, 6)])
    assert kinds(done) == ["hold", "transition", "walk", "walk", "transition"]


def test_a_walk_can_end_in_stride() -> None:
    done = Performer(FakeCharacterModels(), Goal(0, 0)).perform([WalkTo(0, 6)], stop=False)
    assert kinds(done)[-1] == "walk"
    np.testing.assert_allclose(done.motion.root[-1, [0, 2]], [0, 6], atol=0.15)


def test_a_motion_is_gone_on_from() -> None:
    before = stride_of(walking(45, FPS))
    done = Performer(FakeCharacterModels(), before).perform([WalkTo(0, 5)], foot_lock=False)
    assert kinds(done)[0] == "walk"
    np.testing.assert_allclose(done.motion.root[0], before.root[-1] + [0, 0, 1.2 / FPS], atol=1e-4)


def test_a_turn_on_the_spot_comes_before_a_way_that_lies_behind() -> None:
    done = perform([WalkTo(0, -6)])
    assert kinds(done) == ["hold", "transition", "transition", "walk", "transition"]


def test_waiting_stops_a_walk_and_keeps_a_pose() -> None:
    done = perform([WalkTo(0, 5), Wait(1.0), HIGH, Wait(0.5)])
    waits = [segment for segment in done.segments if segment.name == "wait"]
    assert [segment.kind for segment in waits] == ["hold", "hold"]
    np.testing.assert_allclose(done.motion.root[-1], done.motion.root[waits[-1].start], atol=1e-6)


def test_who_sits_gets_up_before_walking_off() -> None:
    done = perform([SIT, WalkTo(0, 2)])
    after = [segment for segment in done.segments if segment.name == "walk to 0.0, 2.0"]
    standing = FakeCharacterModels().standing.root[0, 1]
    assert done.motion.root[after[0].end - 1, 1] == pytest.approx(standing, abs=1e-4)
    assert np.linalg.norm(done.motion.root[after[0].end - 1, [0, 2]] - [0, 11]) < 0.3


def test_a_path_is_followed_from_where_the_character_is() -> None:
    path = Path(np.array([[4, 4], [4, 9]], np.float32))
    done = perform([Follow(path)])
    np.testing.assert_allclose(done.motion.root[-1, [0, 2]], [4, 9], atol=1e-4)
    assert np.linalg.norm(done.motion.root[:, [0, 2]] - [4, 4], axis=1).min() < 0.4


def test_a_scene_is_walked_round_its_obstacles() -> None:
    scene = Scene.from_polygons([[[-3, -1], [3, -1], [3, 9], [-3, 9]]], [[[-1.5, 3], [1, 3], [1, 5], [-1.5, 5]]])
    done = perform([WalkTo(0, 8)], scene=scene)
    walk = next(segment for segment in done.segments if segment.kind == "walk")
    assert scene.grid.is_walkable(done.motion.root[walk.start : walk.end, [0, 2]]).all()


def test_words_become_keypoints_of_the_things_that_are_there() -> None:
    seat = np.stack(np.meshgrid(np.arange(-0.4, 0.4, 0.05), [0.45], np.arange(4, 4.6, 0.05)), axis=-1).reshape(-1, 3)
    floor = np.stack(np.meshgrid(np.arange(-3, 3, 0.2), [0.0], np.arange(-1, 7, 0.2)), axis=-1).reshape(-1, 3)
    cloud = SemanticCloud(np.concatenate([seat, floor]), ["stool"] * len(seat) + ["floor"] * len(floor))
    done = perform([Do("sit on the stool", hold_s=1.0)], cloud=cloud)
    hold = done.segments[-1]
    assert (hold.kind, hold.name) == ("hold", "sit stool")
    np.testing.assert_allclose(hold.keypoints["pelvis"], [0, 0.6, 4.3], atol=0.2)


def test_words_without_names_in_the_scene_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="'sit on the sofa' needs a scene with names"):
        perform([Do("sit on the sofa")])


def test_an_error_names_the_step() -> None:
    too_high = Act({"right_hand": (0.0, 4.0, 3.0)}, name="grab the moon")
    with pytest.raises(ReachError, match=r"step 2 \('grab the moon'\): no plausible pose") as caught:
        perform([WalkTo(0, 2), too_high])
    assert caught.value.miss_cm == {"right_hand": 99.0}


def test_no_way_and_no_progress_are_errors() -> None:
    rooms = Scene.from_polygons([[[-1, -1], [1, -1], [1, 1], [-1, 1]], [[3, -1], [5, -1], [5, 1], [3, 1]]])
    with pytest.raises(PathError, match="step 1"):
        perform([WalkTo(4, 0), WalkTo(0, 0)], scene=rooms)
    with pytest.raises(WalkError):
        Performer(FakeCharacterModels(stays), Goal(0, 0)).perform([WalkTo(0, 6)])


def test_nothing_to_do_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least one action"):
        perform([])


@pytest.mark.parametrize(
    "action", [lambda: Wait(-1), lambda: Stand(float("nan")), lambda: Act({}, hold_s=-2), lambda: Do("sit", -1)]
)
def test_a_time_below_zero_is_refused(action: object) -> None:
    with pytest.raises(InvalidInputError, match="0 or more seconds"):
        action()  # type: ignore[operator]


def test_a_place_that_is_none_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="finite numbers"):
        WalkTo(0, float("inf"))


def test_the_same_seed_gives_the_same_motion_and_another_seed_other_breaths() -> None:
    first, again, other = (perform([HIGH, Wait(1.0)], seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.motion.rotations, again.motion.rotations)
    assert not np.array_equal(first.motion.rotations, other.motion.rotations)


def test_progress_runs_to_a_hundred() -> None:
    told: list[tuple[int, int, str]] = []
    perform([WalkTo(0, 9), HIGH, Wait(1)], progress=lambda *each: told.append(each))
    done, total, names = zip(*told, strict=True)
    assert set(total) == {100}
    assert list(done) == sorted(done)
    assert done[-1] == 100
    assert any(0 < part < 33 for part in done)  # within the first walk
    assert names[-1] == "wait"


def test_a_faster_walk_needs_a_longer_way_to_stop() -> None:
    ends = []
    for speed in (0.8, 1.6):
        done = perform([WalkTo(0, 10)], pace=Pace(speed=speed))
        walk = next(segment for segment in done.segments if segment.kind == "walk")
        ends.append(10 - done.motion.root[walk.end - 1, 2])
    assert ends[1] == pytest.approx(2 * ends[0], rel=0.1)


def test_a_motion_of_a_text_begins_where_the_character_stands_and_ends_in_a_stand() -> None:
    asked = []

    def wave(text: str, seconds: float, seed: int) -> Motion:
        asked.append((text, seconds, seed))
        return walking(60, 20.0, speed=0.1)

    performer = Performer(FakeCharacterModels(), Goal(0, 0), seed=7, generate=wave)
    done = performer.perform([WalkTo(0, 5), Generate("wave", 3.0)], foot_lock=False)
    assert asked == [("wave", 3.0, 7)]
    assert kinds(done)[-3:] == ["transition", "generated", "transition"]
    shown = done.segments[-2]
    np.testing.assert_allclose(done.motion.root[shown.start, [0, 2]], [0, 5], atol=0.3)
    steps = np.linalg.norm(np.diff(done.motion.root, axis=0), axis=1)
    assert steps.max() < 0.1
    np.testing.assert_allclose(
        done.motion.rotations[-1, 1:], FakeCharacterModels().standing.rotations[0, 1:], atol=1e-5
    )


def test_without_a_generator_a_text_names_what_is_missing() -> None:
    with pytest.raises(InvalidInputError, match="needs a generator"):
        perform([Generate("wave", 3.0)])


def test_who_sits_and_shall_stand_elsewhere_gets_up_first_and_steps_there() -> None:
    seat = Act({"pelvis": (0.0, 0.55, 2.0)}, heading=np.pi, approach=(0.0, 1.6), name="sit")
    done = perform([seat, WalkTo(0.9, 1.2)])
    hold = max(index for index, segment in enumerate(done.segments) if segment.kind == "hold")
    up, steps = done.segments[hold + 1 : hold + 3]
    assert (up.kind, steps.kind) == ("transition", "transition")
    risen = done.motion.root[up.end - 1]
    standing = FakeCharacterModels().standing.root[0, 1]
    assert risen[1] == pytest.approx(standing, abs=0.02)
    assert np.hypot(*(risen - done.motion.root[up.start - 1])[[0, 2]]) < 0.3
    np.testing.assert_allclose(done.motion.root[-1, [0, 2]], [0.9, 1.2], atol=0.01)


def test_nobody_walks_away_in_a_pose_that_is_no_stand() -> None:
    done = perform([Act({"pelvis": (0.0, 0.7, 1.0)}, heading=0.0, name="pose"), WalkTo(0, 8)])
    hold = max(index for index, segment in enumerate(done.segments) if segment.kind == "hold")
    after = done.segments[hold + 1]
    assert after.kind == "transition"
    assert done.motion.root[after.end - 1, 1] == pytest.approx(FakeCharacterModels().standing.root[0, 1], abs=0.02)
    assert done.segments[hold + 3].kind == "walk"  # behind its first step
