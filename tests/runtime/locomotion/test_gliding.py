"""Feet that begin to glide: the walk goes on from where it is, as it walked before, and nothing pops."""

from __future__ import annotations

import numpy as np
import pytest
from gaits import gait

from motionrt.locomotion.gliding import FADES_S, Gait
from motionrt.metrics import foot_skate
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.transforms import heading, turned

FPS = 30


def frames_of(motion: Motion) -> np.ndarray:
    return ccf219.encode(motion).astype(np.float64)


def motion_of(frames: np.ndarray) -> Motion:
    return Motion(frames[:, ccf219.ROTATIONS].reshape(len(frames), 24, 3, 3), frames[:, ccf219.ROOT], FPS)


def shown(walker: Gait, frames: np.ndarray, history: np.ndarray) -> np.ndarray:
    for frame in frames:
        walker.show(frame)
        history = walker.revived(np.concatenate([history[1:], frame[None]]))
    return history


@pytest.fixture
def walked() -> tuple[Gait, np.ndarray]:
    """Five seconds of steps along +Z, and the last second of them."""
    frames = frames_of(gait(seconds=5.0, fps=FPS)[0])
    walker = Gait()
    return walker, shown(walker, frames[30:], frames[:30])


def glide(history: np.ndarray, count: int) -> np.ndarray:
    """The last pose, pushed to the side at 1.5 m/s and turned to look there."""
    frames = np.repeat(frames_of(turned(motion_of(history[-1:]), 1.0)), count, axis=0)
    frames[:, ccf219.ROOT] = history[-1, ccf219.ROOT]
    frames[:, 216] += np.arange(1, count + 1) * 1.5 / FPS
    return frames


def revived(walker: Gait, history: np.ndarray, frames: np.ndarray) -> tuple[np.ndarray, int]:
    """The first history that is not what was shown, and which of ``frames`` was the last to be shown."""
    for number, frame in enumerate(frames):
        walker.show(frame)
        history = np.concatenate([history[1:], frame[None]])
        found = walker.revived(history)
        if not np.array_equal(found, history):
            return found, number
    raise AssertionError("it glides on")


def test_a_walk_that_stands_on_its_feet_stays_as_it_is(walked: tuple[Gait, np.ndarray]) -> None:
    _, history = walked
    np.testing.assert_array_equal(history, frames_of(gait(seconds=5.0, fps=FPS)[0])[-30:])


def test_who_glides_goes_on_in_an_earlier_gait_at_the_place_and_in_the_direction_where_he_is(
    walked: tuple[Gait, np.ndarray],
) -> None:
    walker, history = walked
    gliding = glide(history, 40)
    history, number = revived(walker, history, gliding)
    found, now = motion_of(history), motion_of(gliding[number : number + 1])
    assert foot_skate(found.positions()) < 2.0 < foot_skate(motion_of(gliding).positions())
    np.testing.assert_allclose(found.root[-1, [0, 2]], now.root[0, [0, 2]], atol=1e-5)
    assert heading(found)[-1] == pytest.approx(heading(now)[0], abs=0.1)


def test_the_pose_from_before_fades_into_the_gait_without_a_jump(walked: tuple[Gait, np.ndarray]) -> None:
    walker, history = walked
    history, _ = revived(walker, history, glide(history, 40))
    last, held = motion_of(walker.frames[-1][None]), np.repeat(history[-1:], 12, axis=0)
    for frame in held:
        walker.show(frame)
    poses = motion_of(np.stack(walker.frames[-13:])).positions()
    aim = motion_of(held[:1]).positions()[0]
    steps = np.linalg.norm(np.diff(poses, axis=0), axis=-1).max(axis=1)
    np.testing.assert_allclose(poses[0], last.positions()[0], atol=1e-6)
    assert steps.max() <= 0.5 * np.linalg.norm(poses[0] - aim, axis=-1).max() + 1e-6
    np.testing.assert_allclose(poses[round(FADES_S * FPS) + 1 :], np.broadcast_to(aim, poses[10:].shape), atol=1e-5)
