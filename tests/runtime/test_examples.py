"""The examples that are data or plain Python: that they are up to date, and run."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import motionrt
from motionrt.motion.rotations import axis_rotation, matrix_to_quaternion

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(path: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(Path(path).stem, EXAMPLES / path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


class Steps:
    """A stream of one metre a frame, which notes what it is told."""

    def __init__(self, last: int | None = None) -> None:
        self.told: list[motionrt.Goal] = []
        self.last = last

    def stream(self, goal: motionrt.Goal):
        self.told.append(goal)
        frame = 0
        while self.last is None or frame < self.last:
            turn = np.tile(axis_rotation("Y", np.float32(0.1 * frame)), (1, 24, 1, 1))
            told = yield motionrt.Motion(turn, np.array([[frame, 0, 0]]), 30.0)
            if told is not None:
                self.told.append(told)
            frame += 1
        raise motionrt.errors.WalkError("stuck")


def test_a_game_at_60_hz_sees_half_frames_between_those_of_the_stream() -> None:
    loop = example("game_loop.py")
    with loop.Live(Steps(), motionrt.Goal(0, 1)) as character:
        poses = [character.advance(1 / 60) for _ in range(10)]
    np.testing.assert_allclose([pose.root[0] for pose in poses], np.arange(1, 11) / 2, atol=1e-6)
    half = matrix_to_quaternion(axis_rotation("Y", np.array([0.05])))
    np.testing.assert_allclose(np.abs(poses[0].quaternions), np.broadcast_to(half, (24, 4)), atol=1e-6)


def test_a_game_that_hangs_for_a_second_gets_the_pose_of_now() -> None:
    with example("game_loop.py").Live(Steps(), motionrt.Goal(0, 1)) as character:
        assert character.advance(1.0).root[0] == pytest.approx(30.0)


def test_a_new_goal_reaches_the_stream() -> None:
    steps = Steps()
    with example("game_loop.py").Live(steps, motionrt.Goal(0, 1)) as character:
        character.aim(motionrt.Goal(5, 5))
        character.advance(0.5)
    assert steps.told == [motionrt.Goal(0, 1), motionrt.Goal(5, 5)]


def test_an_error_of_the_stream_is_raised_where_the_game_asks() -> None:
    live = example("game_loop.py").Live(Steps(last=5), motionrt.Goal(0, 1))
    with live as character, pytest.raises(motionrt.errors.WalkError, match="stuck"):
        character.advance(1.0)
