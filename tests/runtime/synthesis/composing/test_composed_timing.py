"""Layers in time: trimmed, stretched, looped, and in step."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion
from motionrt.motion.transforms import heading
from motionrt.synthesis.composing import Layer, compose
from motionrt.synthesis.composing.phase import gait_phase, in_phase
from motionrt.synthesis.composing.timing import looped, stretched, warped

WALK, ARMS = ("left leg", "right leg", "global"), ("left arm", "right arm")


def swinging(frames: int, hertz: float, start: float = 0.0, fps: float = 30.0, legs: float = 0.5) -> Motion:
    """Legs and arms that swing like pendulums; the left leg passes the right one, forwards, at whole cycles."""
    swing = np.sin(2 * np.pi * (start + hertz * np.arange(frames) / fps))
    vectors = np.zeros((frames, 24, 3))
    for name, size in (("left_hip", -legs), ("right_hip", legs)):
        vectors[:, SMPL24.index(name), 0] = size * swing
    vectors[:, SMPL24.index("left_shoulder"), 2] = -1.4  # arms down
    vectors[:, SMPL24.index("right_shoulder"), 2] = 1.4
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(frames, 24, 3, 3)
    for name, size in (("left_shoulder", 0.4), ("right_shoulder", -0.4)):
        forwards = Rotation.from_rotvec(np.outer(swing, [size, 0, 0])).as_matrix()
        matrices[:, SMPL24.index(name)] = forwards @ matrices[:, SMPL24.index(name)]
    return Motion(matrices.astype(np.float32), standing(1).root.repeat(frames, axis=0), fps)


def ahead(motion: Motion, pair: tuple[str, str]) -> np.ndarray:
    """How far one joint is ahead of another, metres along +Z."""
    first, second = (motion.positions()[:, SMPL24.index(name), 2] for name in pair)
    return np.asarray(first - second)


def in_step(motion: Motion) -> float:
    """Correlation of the legs' swing with the opposite arms'."""
    feet, hands = ahead(motion, ("left_ankle", "right_ankle")), ahead(motion, ("right_wrist", "left_wrist"))
    return float(np.corrcoef(feet, hands)[0, 1])


@pytest.mark.parametrize(("hertz", "start"), [(0.8, 0.0), (1.0, 0.3), (1.7, 0.75), (2.6, 0.5)])
def test_the_phase_of_a_sinusoidal_gait_is_its_angle(hertz: float, start: float) -> None:
    phase = gait_phase(swinging(120, hertz, start))
    assert phase is not None
    off = phase - (start + hertz * np.arange(120) / 30)
    assert np.abs(off - np.round(off.mean())).max() < 0.02


def test_standing_has_no_phase_and_swinging_arms_have_one() -> None:
    assert gait_phase(standing(60)) is None
    assert gait_phase(random_motion(1)) is None
    assert gait_phase(swinging(20, 1.0)) is None  # two thirds of a cycle
    arms = gait_phase(swinging(120, 1.0, 0.3, legs=0))
    assert arms is not None
    assert arms[-1] - arms[0] == pytest.approx(119 / 30, abs=0.02)


@given(st.floats(0.5, 3), st.floats(0.5, 3), st.floats(0, 1), st.floats(0, 1))
def test_in_phase_reads_the_other_where_it_steps_alike(a: float, b: float, shift: float, late: float) -> None:
    gait, other = shift + a * np.arange(100) / 30, late + b * np.arange(100) / 30
    times = in_phase(gait, other)
    apart = late + b * times / 30 - gait[: len(times)]
    assert len(times) > 0
    assert np.abs(apart - np.round(apart[0])).max() < 1e-9
    assert 0 <= times[0] < 30 / b + 1e-6


def test_arms_swing_with_legs_that_walk_at_another_pace() -> None:
    legs, arms = swinging(150, 1.0, 0.1), swinging(150, 1.4, 0.8)
    layers = [Layer(legs, WALK), Layer(arms, (*ARMS, "torso", "global"))]  # four parts: the walk is B
    apart, together = compose(layers, seam=0), compose(layers, seam=0, align="phase")
    assert in_step(apart) < 0.5
    assert in_step(together) > 0.98
    assert np.array_equal(together.rotations[:, :3], legs.rotations[: together.frames, :3])
    assert together.frames == pytest.approx(150 - 0.3 * 30, abs=45)  # trimmed where the arms run out, if they do


def test_short_arms_go_round_until_the_walk_is_over() -> None:
    legs, arms = swinging(240, 1.0, 0.1), swinging(60, 1.4, 0.8)
    found = compose([Layer(legs, WALK), Layer(arms, ARMS)], align="phase", seconds=8)
    assert found.frames == 240
    assert in_step(found) > 0.95


def test_the_shortest_layer_decides_the_length() -> None:
    found = compose([random_motion(30), Layer(random_motion(20), "torso"), Layer(random_motion(25), "left arm")])
    assert found.frames == 20


def test_stretching_brings_both_ends_together_in_the_carriers_time() -> None:
    walk, arm = walking(60), random_motion(31, seed=2)
    found = compose([walk, Layer(arm, "right arm")], align="stretch", seam=0)
    assert found.frames == 60
    assert np.array_equal(found.root, walk.root)
    assert np.array_equal(found.rotations[[0, -1], 21], arm.rotations[[0, -1], 21])
    slow = compose([walk, Layer(arm, "right arm")], align="stretch", seconds=6)
    assert slow.frames == 120
    assert np.linalg.norm(np.diff(slow.root, axis=0), axis=1).mean() * 20 == pytest.approx(1.2 * 59 / 119, rel=1e-3)


def test_between_frames_is_halfway_round() -> None:
    motion = random_motion(4, seed=5)
    found = warped(motion, np.array([0, 1.5, 3]))
    step = Rotation.from_matrix(motion.rotations[1, 7]).inv() * Rotation.from_matrix(motion.rotations[2, 7])
    expected = Rotation.from_matrix(motion.rotations[1, 7]) * Rotation.from_rotvec(step.as_rotvec() / 2)
    assert np.abs(found.rotations[1, 7] - expected.as_matrix()).max() < 2e-6
    assert np.array_equal(found.rotations[[0, 2]], motion.rotations[[0, 3]])
    assert stretched(motion, 4).root == pytest.approx(motion.root)


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_a_looped_walk_walks_on_at_its_speed(turn: float) -> None:
    walk = walking(50, turn=turn)
    found = looped(walk, 400)
    assert np.array_equal(found.rotations[:25], walk.rotations[:25])
    speed = np.linalg.norm(np.diff(found.root, axis=0), axis=1) * 20
    assert np.abs(speed - 1.2).max() < 0.1
    turns = np.diff(np.unwrap(heading(found))) * 20
    assert np.abs(turns - turn).max() < 0.1
    steps = np.abs(np.diff(found.rotations, axis=0)).max()
    assert steps < 1.3 * np.abs(np.diff(walk.rotations, axis=0)).max()


@given(st.integers(1, 40), st.integers(1, 200))
def test_a_loop_has_the_length_asked_for_and_starts_as_the_motion(frames: int, wanted: int) -> None:
    motion = random_motion(frames, seed=7)
    found = looped(motion, wanted)
    assert found.frames == wanted
    shared = min(wanted, max(1, frames // 2))
    assert np.array_equal(found.rotations[:shared], motion.rotations[:shared])
    assert np.abs(found.root[:, 1]).max() <= np.abs(motion.root[:, 1]).max() + 1e-5


def test_seconds_loop_what_is_short_and_cut_what_is_long() -> None:
    walk, wave = walking(60), random_motion(15, seed=3)
    assert compose([walk, Layer(wave, "right arm")], seconds=2).frames == 40
    found = compose([walk, Layer(wave, "right arm")], seconds=7.5)
    assert found.frames == 150
    assert found.root[-1, 2] == pytest.approx(1.2 * 7.5, abs=0.3)
