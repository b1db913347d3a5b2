"""Walks along paths: all waypoints, in time, and an error instead of a character that never arrives."""

from __future__ import annotations

import numpy as np
import pytest
from fake_character_models import FPS, stays, towards_goal
from motions import walking

from motionrt.errors import InvalidInputError, WalkError
from motionrt.locomotion.crowd import SPEED
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.leading import MOST_HURRIED
from motionrt.locomotion.path import Path
from motionrt.locomotion.path_following import PATIENCE_S, Pace, walk, walk_together
from motionrt.locomotion.starting_poses import stride_of
from motionrt.metrics import waypoints_reached
from motionrt.motion.rotations import axis_rotation

STRIDE = stride_of(walking(40, FPS))
CORNER = Path(np.array([[0, 0], [0, 6], [5, 6]], np.float32))


def test_a_walk_takes_the_time_that_its_length_and_speed_say() -> None:
    path = Path(np.array([[0, 0], [0, 9]], np.float32))
    motion = walk(towards_goal, STRIDE, path, Pace(speed=1.5))
    assert motion.frames == pytest.approx(9 / 1.5 * FPS, abs=3)
    np.testing.assert_allclose(motion.root[-1, [0, 2]], [0, 9], atol=0.1)
    assert motion.root[0, 2] == pytest.approx(1.5 / FPS, abs=1e-4)  # the first new frame


def test_who_shall_be_slower_than_people_walk_walks_all_the_same_and_takes_longer() -> None:
    asked: list[float] = []

    def remembers(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        asked.extend(speed.tolist())
        return towards_goal(frames, speed)

    path = Path(np.array([[0, 0], [0, 6]], np.float32))
    motion = walk(remembers, STRIDE, path, Pace(speed=0.3))
    assert min(asked) >= SPEED - 1e-6
    assert motion.frames == pytest.approx(6 / 0.3 * FPS, abs=12)
    steps = np.linalg.norm(np.diff(motion.root[:, [0, 2]], axis=0), axis=1) * FPS
    assert np.median(steps) == pytest.approx(0.3, abs=0.02)


@pytest.mark.parametrize(("share", "found"), [(0.9, 1.2), (1.1, 1.2), (0.5, 1.2 * 0.5 * MOST_HURRIED)])
def test_who_goes_slower_or_faster_than_asked_is_played_in_time_within_limits(share: float, found: float) -> None:
    path = Path(np.array([[0, 0], [0, 12]], np.float32))
    motion = walk(lambda frames, speed: towards_goal(frames, share * speed), STRIDE, path, Pace(speed=1.2))
    steps = np.linalg.norm(np.diff(motion.root[:, [0, 2]], axis=0), axis=1) * FPS
    assert np.median(steps) == pytest.approx(found, abs=0.01)


def test_every_waypoint_of_a_path_with_corners_is_passed() -> None:
    motion = walk(towards_goal, STRIDE, CORNER)
    assert waypoints_reached(motion.root[:, [0, 2]], CORNER.waypoints(1.0).positions, 0.4) == 1.0


def test_a_walk_breaks_off_before_the_end_if_asked_to() -> None:
    motion = walk(towards_goal, STRIDE, CORNER, Pace().before_end(1.2))
    assert np.linalg.norm(motion.root[-1, [0, 2]] - [5, 6]) == pytest.approx(1.2, abs=0.05)


def test_characters_of_different_ways_end_each_at_its_own() -> None:
    paths = [CORNER, Path(np.array([[3, 0], [3, 2]], np.float32)), Path(np.array([[-2, 0], [-2, 12]], np.float32))]
    starts = [uncanonicalise(STRIDE, Goal(x, 0.0)) for x in (0.0, 3.0, -2.0)]
    together = walk_together(towards_goal, starts, paths)
    for motion, start, path in zip(together, starts, paths, strict=True):
        alone = walk(towards_goal, start, path)
        assert motion.frames == alone.frames
        np.testing.assert_allclose(motion.root, alone.root, atol=1e-4)
        np.testing.assert_allclose(motion.rotations, alone.rotations, atol=1e-4)


def test_a_character_that_is_stuck_is_an_error_and_no_endless_loop() -> None:
    with pytest.raises(WalkError, match=r"stays 1\.00 m from waypoint 1 of 11 at x 0\.00, z 1\.00"):
        walk(stays, STRIDE, CORNER)


def test_a_character_that_walks_round_its_goal_is_stuck_too() -> None:
    calls = [0]

    def in_circles(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        calls[0] += 1
        out = frames[:, -1].copy()
        facing = np.arctan2(out[:, 2], out[:, 8]) + 0.15
        out[:, :9] = axis_rotation("Y", facing).reshape(-1, 9)
        out[:, 216] += 0.04 * np.sin(facing)
        out[:, 218] += 0.04 * np.cos(facing)
        return out

    with pytest.raises(WalkError, match="larger radius"):
        walk(in_circles, STRIDE, Path(np.array([[0, 0], [0, 3]], np.float32)), Pace(spacing=3.0))
    assert calls[0] <= 2 * PATIENCE_S * FPS


def test_progress_counts_the_metres_of_all() -> None:
    told: list[tuple[int, int, str]] = []
    walk_together(towards_goal, [STRIDE, STRIDE], [CORNER, CORNER], progress=lambda *each: told.append(each))
    done, total, _ = zip(*told, strict=True)
    assert set(total) == {22}
    assert list(done) == sorted(done)
    assert 0 < done[-1] <= 22


@pytest.mark.parametrize("speed", [0.0, 0.2, 9.0, float("nan")])
def test_a_speed_that_nobody_walks_is_refused(speed: float) -> None:
    with pytest.raises(InvalidInputError, match=r"0\.3 and 5 m/s"):
        Pace(speed=speed)


@pytest.mark.parametrize("bad", [{"spacing": 0.0}, {"radius": -1.0}, {"until": -0.1}])
def test_distances_that_make_no_sense_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(InvalidInputError, match="spacing and radius"):
        Pace(**bad)


def test_as_many_starts_as_paths_are_needed() -> None:
    with pytest.raises(InvalidInputError, match="one start for every path"):
        walk_together(towards_goal, [STRIDE], [CORNER, CORNER])
    with pytest.raises(InvalidInputError, match="one start for every path"):
        walk_together(towards_goal, [], [])


def test_a_path_that_ends_here_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="nothing to walk"):
        walk(towards_goal, STRIDE, Path(np.array([[0, -0.5], [0, 0.05]], np.float32)))
