"""Flat ground: standing feet come to y = 0 all along a recording."""

from __future__ import annotations

import numpy as np
from gaits import gait
from motions import standing

from motionrt.motion import Motion
from motionrt.motion.feet.flat_ground import flat_ground, upright_ground
from motionrt.motion.transforms import moved

TOES = [10, 11]


def raised(motion: Motion, heights: np.ndarray) -> Motion:
    root = motion.root.copy()
    root[:, 1] += heights
    return Motion(motion.rotations, root, motion.fps)


def test_a_walk_that_climbs_a_slope_comes_to_walk_on_the_level() -> None:
    motion, known = gait(seconds=12)
    flat = flat_ground(raised(motion, 0.1 + np.linspace(0, 0.1, motion.frames)))
    toes = flat.positions()[:, TOES, 1]
    assert np.abs(toes[known]).max() < 0.015
    assert np.abs(toes[known].mean()) < 0.005


def test_a_toe_that_dips_once_does_not_lift_all_the_other_steps() -> None:
    motion, known = gait(seconds=6)
    dip = np.zeros(motion.frames)
    dip[60:64] = -0.06
    spoiled = raised(motion, dip)
    assert spoiled.grounded().positions()[:, TOES, 1][known].mean() > 0.04
    assert np.median(np.abs(flat_ground(spoiled).positions()[:, TOES, 1][known])) < 0.005


def test_a_jump_keeps_its_height() -> None:
    time = np.arange(90) / 30
    jump = 0.4 * np.clip(1 - ((time - 1.5) / 0.3) ** 2, 0, None)
    flat = flat_ground(raised(standing(90, fps=30), jump + 0.05))
    toes = flat.positions()[:, TOES[0], 1]
    assert abs(toes.max() - 0.4) < 0.01
    assert np.abs(toes[:30]).max() < 0.01


def test_a_walk_on_the_floor_stays_and_no_rotation_changes() -> None:
    motion, _ = gait()
    flat = flat_ground(motion)
    np.testing.assert_allclose(flat.root, motion.root, atol=0.003)
    np.testing.assert_array_equal(flat.rotations, motion.rotations)


def test_without_a_standing_foot_it_is_grounded() -> None:
    still = standing(30, fps=30)
    flying = raised(still, 1 + 2 * np.arange(30) / 30)
    np.testing.assert_allclose(flat_ground(flying).root, flying.grounded().root, atol=1e-5)


def test_the_upright_come_onto_the_ground_and_the_lying_stay() -> None:
    still = standing(60, fps=30)
    hovers = moved(still, np.array([0, 0.06, 0], np.float32))
    assert np.allclose(upright_ground(hovers).root, still.root, atol=0.02)
    rotations = still.rotations.copy()
    rotations[:, 0] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # on the back
    lies = Motion(rotations, np.tile(np.array([0, 0.12, 0], np.float32), (60, 1)), 30)
    assert np.array_equal(upright_ground(lies).root, lies.root)
