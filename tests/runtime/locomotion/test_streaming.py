"""A character for a game's loop: it goes where it is told, from the next frame on."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels, Strafes, turns_gently
from motions import random_motion, walking

from motionrt.errors import InvalidInputError
from motionrt.locomotion.bearings import facing_of
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.leading import STRAFES_TO
from motionrt.locomotion.starting_poses import stride_of
from motionrt.locomotion.streaming import stream
from motionrt.motion import Motion
from motionrt.motion.rotations import wrapped


def frames(goal: Goal, count: int, start: Goal | Motion | None = None, **options: object) -> list[Motion]:
    return list(islice(stream(FakeCharacterModels(), start or Goal(0, 0), goal, **options), count))


def roots(motions: list[Motion]) -> np.ndarray:
    return np.concatenate([motion.root[:, [0, 2]] for motion in motions])


def test_it_arrives_and_stays_facing_as_told() -> None:
    seen = frames(Goal(3, 8, np.pi / 2), 500)
    assert {motion.frames for motion in seen} == {1}
    np.testing.assert_allclose(roots(seen[-30:]), np.tile([3, 8], (30, 1)), atol=0.02)
    assert facing_of(seen[-1]) == pytest.approx(np.pi / 2, abs=0.05)
    assert np.linalg.norm(np.diff(roots(seen), axis=0), axis=1).max() < 0.1


def test_a_new_goal_takes_effect_from_the_next_frame() -> None:
    walker = stream(FakeCharacterModels(turns_gently), stride_of(walking(60, FPS)), Goal(0, 20))
    before = [next(walker) for _ in range(30)]
    after = [walker.send(Goal(20, 1, 0)), *islice(walker, 9)]
    assert np.diff(roots(before), axis=0)[:, 0] == pytest.approx(0, abs=1e-6)
    steps = np.diff(roots([before[-1], *after]), axis=0)
    assert (np.diff(steps[:, 0]) > 0.0005).all()  # it turns there from frame to frame
    assert (np.linalg.norm(steps, axis=1) < 0.05).all()


def leaps(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """The last frame, a metre on."""
    out = frames[:, -1].copy()
    out[:, 218] += 1.0
    return out


def test_a_walk_that_leaps_is_not_shown() -> None:
    seen = list(islice(stream(FakeCharacterModels(leaps), stride_of(walking(60, FPS)), Goal(0, 20)), 60))
    assert np.linalg.norm(np.diff(roots(seen), axis=0), axis=1).max() < 0.1


@pytest.mark.parametrize("goal", [Goal(0.3, 0.4), Goal(-0.8, 0.1, 1.0), Goal(0, -0.7), Goal(0, 0, 3.0)])
def test_a_near_goal_is_stepped_to(goal: Goal) -> None:
    seen = frames(goal, 150, Goal(0, 0), foot_lock=False)
    np.testing.assert_allclose(roots(seen)[-1], [goal.x, goal.z], atol=0.02)
    assert abs(wrapped(facing_of(seen[-1]) - goal.heading)) < 0.05
    ankles = np.concatenate([motion.positions()[:, [7, 8], 1] for motion in seen])
    assert (ankles.max(axis=0) - ankles[0] > 0.04).all()


def test_a_stick_leads_until_a_goal_is_given() -> None:
    walker = stream(FakeCharacterModels(turns_gently), stride_of(walking(60, FPS)), Goal(0, 20))
    seen = [walker.steer((1.0, 0.0)) for _ in range(90)]
    assert np.diff(roots(seen), axis=0)[-1] == pytest.approx([1.0 / FPS, 0.0], abs=0.01)
    seen = [walker.steer((0.0, 0.0)) for _ in range(120)]
    np.testing.assert_allclose(roots(seen[-20:]), np.tile(roots(seen[-1:]), (20, 1)), atol=0.02)
    x, z = roots(seen[-1:])[0]
    walker.send(Goal(float(x), float(z) + 0.6))
    assert roots(list(islice(walker, 150)))[-1] == pytest.approx([x, z + 0.6], abs=0.03)


@pytest.mark.parametrize("velocity", [(np.nan, 0.0), (9.0, 0.0)])
def test_a_stick_that_nobody_can_follow_is_refused(velocity: tuple[float, float]) -> None:
    with pytest.raises(InvalidInputError, match="wish"):
        stream(FakeCharacterModels(), Goal(0, 0), Goal(0, 0)).steer(velocity)


def test_a_goal_sent_while_it_stands_makes_it_set_off() -> None:
    walker = stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, 0))
    np.testing.assert_allclose(roots(list(islice(walker, 90))), 0, atol=0.02)
    walker.send(Goal(-6, 0, 0))
    assert roots(list(islice(walker, 400)))[-1] == pytest.approx([-6, 0], abs=0.02)


def test_a_goal_that_lies_behind_is_turned_to_first() -> None:
    seen = list(islice(stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, -8)), 600))
    place = roots(seen)
    assert np.abs(place[:60]).max() < 0.3  # turns on the spot
    np.testing.assert_allclose(place[-1], [0, -8], atol=0.02)


@pytest.mark.parametrize("goal", [Goal(0, -2.6, 0.0), Goal(1.0, -4.5, 0.5), Goal(-5.0, 0.0, 1.5), Goal(0, 8.0, np.pi)])
def test_a_goal_that_stands_still_is_reached_in_its_distance_at_the_speed_and_three_seconds(goal: Goal) -> None:
    due = np.hypot(goal.x, goal.z) / 1.2 + 3.0
    seen = list(islice(stream(FakeCharacterModels(turns_gently), Goal(0, 0), goal), int(due * FPS) + 1))
    assert roots(seen)[-1] == pytest.approx([goal.x, goal.z], abs=0.05)


def test_goals_at_less_than_the_speed_of_walks_are_stepped_to() -> None:
    def never(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        raise AssertionError("walked")

    seen = list(islice(stream(FakeCharacterModels(never), Goal(0, 0), Goal(0, 6), speed=0.3), int((20 + 3) * FPS)))
    root = np.concatenate([frame.root for frame in seen])
    assert np.hypot(*(root[-1, [0, 2]] - [0, 6])) < 0.03
    assert 6 / np.flatnonzero(root[:, 2] > 5.9)[0] * FPS == pytest.approx(0.3, abs=0.05)


def test_a_turn_before_a_walk_takes_effect_at_its_landings() -> None:
    walker = stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, -8))
    seen = list(islice(walker, 20))
    seen += [walker.send(Goal(0, 0, 0.0)), *islice(walker, 150)]
    assert roots(seen)[-1] == pytest.approx([0, 0], abs=0.03)
    assert abs(wrapped(facing_of(seen[-1]))) < 0.06


def test_a_motion_is_gone_on_from() -> None:
    first = frames(Goal(0, 9), 1, stride_of(walking(60, FPS)), foot_lock=False)[0]
    np.testing.assert_allclose(first.root[0, [0, 2]], [0, 1.2 / FPS], atol=1e-4)


class Drifting(FakeCharacterModels):
    """Holds that slide by a millimetre a frame."""

    def hold(self, pose: Motion, seconds: float, seed: int) -> Motion:
        held = super().hold(pose, seconds, seed)
        return replace(held, root=held.root + np.arange(held.frames)[:, None] * np.array([0.001, 0, 0], np.float32))


def test_locked_feet_do_not_slide() -> None:
    def slide(foot_lock: bool) -> float:
        seen = list(islice(stream(Drifting(), Goal(0, 0), Goal(0, 0), foot_lock=foot_lock), 40))
        toes = np.concatenate([motion.positions()[:, [10, 11]] for motion in seen])
        return float(np.linalg.norm(toes[-1] - toes[5], axis=-1).max())

    assert slide(False) > 0.03
    assert slide(True) < 0.002


def test_another_frame_rate_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="resample"):
        next(stream(FakeCharacterModels(), random_motion(30, 20.0), Goal(0, 5)))


def test_random_goals_at_random_times_never_make_it_leap() -> None:
    rng = np.random.default_rng(3)
    walker, seen = stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, 2)), list[Motion]()
    for _ in range(40):
        x, z = roots(seen[-1:])[0] if seen else (0.0, 0.0)
        far, way = rng.choice([0.1, 1.0, 3.0, 9.0]), rng.uniform(-np.pi, np.pi)
        goal = Goal(x + far * np.sin(way), z + far * np.cos(way), rng.uniform(-3, 3))
        seen += [walker.send(goal), *islice(walker, int(rng.integers(0, 50)))]
    speed = np.linalg.norm(np.diff(np.concatenate([motion.root for motion in seen]), axis=0), axis=1) * FPS
    turn = np.abs(wrapped(np.diff([facing_of(motion) for motion in seen]))) * FPS
    assert speed.max() < 6.0
    assert np.degrees(turn.max()) < 400.0


@pytest.mark.parametrize(("velocity", "facing"), [((0.0, -0.7), 0.0), ((0.5, 0.0), 0.0), ((0.0, 0.3), None)])
def test_backward_sideways_and_slow_sticks_are_stepped_at_their_speed(
    velocity: tuple[float, float], facing: float | None
) -> None:
    walker = stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, 0))
    seen = [walker.steer(velocity, facing) for _ in range(120)]
    way = (roots(seen)[-1] - roots(seen)[59]) * FPS / 60
    np.testing.assert_allclose(way, velocity, atol=0.12)
    assert abs(facing_of(seen[-1])) < 0.1
    ankles = np.concatenate([motion.positions()[:, [7, 8], 1] for motion in seen])
    assert (ankles.max(axis=0) - ankles[0] > 0.04).all()


@pytest.mark.parametrize(("velocity", "facing"), [((0.0, -0.9), 0.0), ((0.8, 0.0), 0.0), ((0.7, -0.7), 0.5)])
def test_a_network_that_knows_wishes_walks_where_the_stick_points_and_looks_where_it_looks(
    velocity: tuple[float, float], facing: float
) -> None:
    walker = stream(FakeCharacterModels(Strafes()), Goal(0, 0), Goal(0, 0))
    seen = [walker.steer(velocity, facing) for _ in range(90)]
    way = (roots(seen)[-1] - roots(seen)[59]) * FPS / 30
    np.testing.assert_allclose(way, velocity, atol=0.01)
    assert facing_of(seen[-1]) == pytest.approx(facing, abs=0.02)
    ahead = [walker.steer((0.0, 1.2)) for _ in range(120)]  # and ahead again, as every network does
    assert roots(ahead)[-1, 1] - roots(ahead)[60, 1] > 1.5


def test_what_a_stick_wants_faster_than_anybody_strafes_is_strafed_slower() -> None:
    walker = stream(FakeCharacterModels(Strafes()), Goal(0, 0), Goal(0, 0))
    seen = [walker.steer((4.0, 0.0), 0.0) for _ in range(60)]
    assert (roots(seen)[-1, 0] - roots(seen)[29, 0]) * FPS / 30 == pytest.approx(STRAFES_TO, abs=0.05)


def test_the_first_step_of_a_walk_is_finished_before_something_else_begins() -> None:
    walker = stream(FakeCharacterModels(turns_gently), Goal(0, 0), Goal(0, 9))
    seen = list(islice(walker, 8))  # a foot is in the air
    seen += [walker.send(Goal(0, 0)), *islice(walker, 59)]
    ankles = np.concatenate([motion.positions()[:, [7, 8]] for motion in seen])
    assert (np.linalg.norm(np.diff(ankles, axis=0), axis=-1).max() * FPS) < 6.0
    assert roots(seen)[-1] == pytest.approx([0, 0], abs=0.03)
