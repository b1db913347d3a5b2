"""Foot locking: standing feet stand, everything else stays, and nothing pops."""

from __future__ import annotations

import numpy as np
import pytest
from gaits import gait
from motions import random_motion, standing, walking

from motionrt.errors import InvalidInputError
from motionrt.metrics import foot_skate, jerk
from motionrt.motion import SMPL24, Motion, Skeleton
from motionrt.motion.feet.live_lock import FootLocker
from motionrt.motion.feet.lock import lock_feet, planted_toes
from motionrt.motion.transforms import moved

TOES, ANKLES = [10, 11], [7, 8]
ABOVE = [j for j in range(24) if j not in (0, 1, 2, 4, 5, 7, 8, 10, 11)]


def streamed(motion: Motion) -> Motion:
    locker = FootLocker(motion.fps)
    frames = [locker.step(rotations, root) for rotations, root in zip(motion.rotations, motion.root, strict=True)]
    return Motion(np.stack([r for r, _ in frames]), np.stack([p for _, p in frames]), motion.fps)


def largest_move(a: Motion, b: Motion) -> float:
    return float(np.linalg.norm(a.positions() - b.positions(), axis=-1).max())


@pytest.mark.parametrize("lock", [lock_feet, streamed])
@pytest.mark.parametrize("fps", [30, 60])
def test_a_sliding_walk_stops_sliding(lock, fps: float) -> None:  # type: ignore[no-untyped-def]
    clean, sliding = gait(fps=fps)[0], gait(fps=fps, slide=0.15)[0]
    as_it_leaves_and_lands, locked = foot_skate(clean.positions()), lock(sliding)
    assert foot_skate(sliding.positions()) > 2 * as_it_leaves_and_lands
    assert foot_skate(locked.positions()) <= as_it_leaves_and_lands
    assert jerk(locked.positions(), fps) < 2 * jerk(sliding.positions(), fps)  # a gait far smoother than real ones
    assert largest_move(locked, sliding) < 0.15


def test_a_pinned_toe_does_not_move_at_all_within_its_contact() -> None:
    motion, known = gait(slide=0.15)
    toes = lock_feet(motion, known).positions()[:, TOES]
    steps = np.linalg.norm(np.diff(toes, axis=0), axis=-1)
    assert steps[known[1:] & known[:-1]].max() < 1e-4
    assert steps.max() > 0.02  # and moves between them


@pytest.mark.parametrize("lock", [lock_feet, streamed])
def test_a_clean_walk_is_nearly_left_alone(lock) -> None:  # type: ignore[no-untyped-def]
    motion, _ = gait()
    assert largest_move(lock(motion), motion) < 0.03
    assert np.linalg.norm(lock(motion).positions() - motion.positions(), axis=-1).mean() < 0.002
    still = standing(30)
    assert largest_move(lock(still), still) < 0.001


def test_the_mirrored_motion_gives_the_mirrored_result() -> None:
    motion, _ = gait(slide=0.2)
    expected = lock_feet(motion).mirror().positions()
    np.testing.assert_allclose(lock_feet(motion.mirror()).positions(), expected, atol=1e-4)
    np.testing.assert_allclose(streamed(motion.mirror()).positions(), streamed(motion).mirror().positions(), atol=1e-4)


@pytest.mark.parametrize("lock", [lock_feet, streamed])
def test_bones_feet_and_the_upper_body_keep_their_shape(lock) -> None:  # type: ignore[no-untyped-def]
    motion, _ = gait(slide=0.2)
    locked = lock(motion)
    identity = np.swapaxes(locked.rotations, -1, -2) @ locked.rotations
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), atol=1e-5)
    np.testing.assert_allclose(locked.rotations[:, ABOVE], motion.rotations[:, ABOVE], atol=1e-6)
    np.testing.assert_allclose(locked.global_rotations()[:, ANKLES], motion.global_rotations()[:, ANKLES], atol=1e-5)
    np.testing.assert_allclose(locked.root[:, [0, 2]], motion.root[:, [0, 2]], atol=1e-6)
    sunk = motion.root[:, 1] - locked.root[:, 1]
    assert sunk.min() > -1e-6
    assert sunk.max() < 0.051


@pytest.mark.parametrize("lock", [lock_feet, streamed])
def test_toes_are_never_below_the_floor(lock) -> None:  # type: ignore[no-untyped-def]
    motion, _ = gait(slide=0.1)
    sunken = moved(motion, np.array([0, -0.03, 0]))
    assert sunken.positions()[:, TOES, 1].min() < -0.02
    assert lock(sunken).positions()[:, TOES, 1].min() > -1e-4


@pytest.mark.parametrize("lock", [lock_feet, streamed])
def test_a_swinging_toe_keeps_clear_of_the_floor_and_a_standing_one_does_not(lock) -> None:  # type: ignore[no-untyped-def]
    motion, known = gait(lift=0.005)
    locked = lock(motion).positions()[:, TOES]
    speed = np.linalg.norm(np.diff(motion.positions()[:, TOES], axis=0), axis=-1) * motion.fps
    assert locked[1:, :, 1][speed > 1.9].min() > 0.02
    assert locked[known][:, 1].max() < 0.005


def test_level_puts_standing_toes_on_the_floor() -> None:
    motion, known = gait()
    raised = moved(motion, np.array([0, 0.02, 0]))
    locked = lock_feet(raised, known, level=True).positions()[:, TOES, 1]
    np.testing.assert_allclose(locked[known], 0, atol=2e-3)
    np.testing.assert_allclose(lock_feet(raised, known).positions()[:, TOES, 1][known], 0.02, atol=2e-3)


def test_the_pelvis_sinks_for_a_foot_that_would_not_reach() -> None:
    motion, known = gait(slide=0.3)
    tall = moved(motion, np.array([0, 0.03, 0]))
    locked = lock_feet(tall, known, level=True)
    assert (tall.root - locked.root)[:, 1].max() > 0.005
    assert np.abs(np.diff(locked.root[:, 1], n=2)).max() < 0.01


def test_a_heel_rolls_off_over_a_toe_that_stays() -> None:
    still = standing(40, fps=30)
    angle = np.deg2rad(40) * np.clip((np.arange(40) - 10) / 20, 0, 1)
    rotations, root = still.rotations.copy(), still.root.copy()
    rotations[:, ANKLES, 1, 1] = rotations[:, ANKLES, 2, 2] = np.cos(angle)[:, None]
    rotations[:, ANKLES, 2, 1], rotations[:, ANKLES, 1, 2] = np.sin(angle)[:, None], -np.sin(angle)[:, None]
    foot = SMPL24.offsets[10]
    turned = np.stack([foot[1] * np.cos(angle) - foot[2] * np.sin(angle)], axis=1)
    root[:, 1] += foot[1] - turned[:, 0]  # rise with the heels
    root[:, 0] += 0.1 * np.arange(40) / 30  # and slide
    rising = Motion(rotations, root, 30)
    locked = lock_feet(rising).positions()
    assert np.linalg.norm(np.diff(locked[:, TOES], axis=0), axis=-1).max() < 0.002
    assert locked[-1, ANKLES, 1].min() - locked[0, ANKLES, 1].max() > 0.05


def test_a_toe_that_wanders_through_its_contact_is_not_torn_back() -> None:
    still = standing(120, fps=30)
    root = still.root + np.outer(np.arange(120) / 30, [0.4, 0, 0]).astype(np.float32)  # 1.6 m at a crawl
    gliding = Motion(still.rotations, root, 30)
    assert not planted_toes(gliding).any()
    assert largest_move(lock_feet(gliding), gliding) < 1e-3
    assert largest_move(streamed(gliding), gliding) < 0.13


def test_many_characters_step_at_once_as_each_would_alone() -> None:
    motions = [gait(slide=0.2)[0], gait(slide=-0.1, speed=0.4)[0], walking(120, fps=30.0)]
    locker = FootLocker(30)
    for f in range(60):
        pose, root = locker.step(np.stack([m.rotations[f] for m in motions]), np.stack([m.root[f] for m in motions]))
    for i, motion in enumerate(motions):
        alone = streamed(motion[:60])
        np.testing.assert_allclose(pose[i], alone.rotations[-1], atol=1e-5)
        np.testing.assert_allclose(root[i], alone.root[-1], atol=1e-5)


def test_a_streamed_frame_depends_on_no_later_one() -> None:
    motion, _ = gait(slide=0.2)
    np.testing.assert_array_equal(streamed(motion).root[:50], streamed(motion[:50]).root)
    np.testing.assert_array_equal(streamed(motion).rotations[:50], streamed(motion[:50]).rotations)


def test_reset_forgets_the_past() -> None:
    motion, _ = gait(slide=0.2)
    locker = FootLocker(30)
    first = locker.step(motion.rotations[0], motion.root[0])
    for f in range(1, 30):
        locker.step(motion.rotations[f], motion.root[f])
    locker.reset()
    again = locker.step(motion.rotations[0], motion.root[0])
    np.testing.assert_array_equal(first[0], again[0])
    np.testing.assert_array_equal(first[1], again[1])


@pytest.mark.parametrize("seed", range(4))
def test_any_motion_comes_back_finite(seed: int) -> None:
    for motion in (random_motion(40, seed=seed), random_motion(1, seed=seed), random_motion(3, seed=seed)):
        assert np.isfinite(lock_feet(motion).positions()).all()
        assert np.isfinite(streamed(motion).positions()).all()


def test_wrong_arguments_are_named() -> None:
    motion, known = gait()
    with pytest.raises(InvalidInputError, match=r"contacts must have the shape \(120, 2\)"):
        lock_feet(motion, known[:10])
    other = Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets * 2)
    with pytest.raises(InvalidInputError, match="smpl24"):
        lock_feet(Motion(motion.rotations, motion.root, 30, other))
    with pytest.raises(InvalidInputError, match="fps"):
        FootLocker(0)
    locker = FootLocker(30)
    locker.step(motion.rotations[0], motion.root[0])
    with pytest.raises(InvalidInputError, match="batch"):
        locker.step(motion.rotations[:2], motion.root[:2])
