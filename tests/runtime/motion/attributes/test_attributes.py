"""Measures against clips with known answers: circles of known radius, turns of known angle, raised arms, jumps."""

from __future__ import annotations

import time

import made
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.attributes import ATTRIBUTES, Attributes, measure

FPS = made.FPS


@pytest.mark.parametrize("radius", [0.8, 1.5, 3.0])
@pytest.mark.parametrize("degrees", [120.0, -240.0, 360.0])
def test_a_walk_along_a_circle_has_its_radius_and_angle(radius: float, degrees: float) -> None:
    seconds = np.radians(abs(degrees)) * radius / 1.2
    a = measure(made.circle(radius, degrees, seconds), FPS)
    assert a.path_radius == pytest.approx(radius, rel=0.05)
    assert a.path_bend == pytest.approx(degrees, abs=12)
    assert a.turn == pytest.approx(degrees, abs=6)
    assert a.path_length == pytest.approx(np.radians(abs(degrees)) * radius, rel=0.03)
    assert a.walk_forward == pytest.approx(a.path_length, rel=0.03)
    assert abs(a.walk_left) < 0.05 * a.path_length
    assert a.speed_mean == pytest.approx(1.2, rel=0.05)


@pytest.mark.parametrize("fps", [20.0, 30.0, 60.0, 120.0])
def test_the_frame_rate_does_not_matter(fps: float) -> None:
    a, b = (measure(made.circle(1.5, 180, 4, rate), rate) for rate in (fps, 30.0))
    assert a.row() == pytest.approx(b.row(), rel=0.03, abs=0.03 * 180 / 10)


@pytest.mark.parametrize("degrees", [-170, -90, 20, 90, 175, 400])
def test_a_turn_on_the_spot_has_its_angle(degrees: float) -> None:
    yaw = np.radians(np.clip(np.linspace(-0.2, 1.2, 120), 0, 1) * degrees)
    a = measure(made.led(made.standing(120), np.zeros((120, 2)), yaw), FPS)
    assert a.turn == pytest.approx(degrees, abs=0.5)
    assert a.spin_extent == pytest.approx(abs(degrees), abs=0.5)
    assert a.in_place
    assert a.path_length < 0.05


@pytest.mark.parametrize(("forward", "left"), [(2.0, 0.0), (-1.5, 0.0), (0.0, 1.0), (0.5, -2.0)])
@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.5])
def test_travel_is_told_in_the_frame_of_the_first_pose(forward: float, left: float, yaw: float) -> None:
    step = np.array([forward * np.sin(yaw) + left * np.cos(yaw), forward * np.cos(yaw) - left * np.sin(yaw)])
    path = np.linspace(0, 1, 61)[:, None] * step
    a = measure(made.led(made.standing(61), path, np.full(61, yaw)), FPS)
    assert (a.travel_forward, a.travel_left) == pytest.approx((forward, left), abs=1e-6)
    assert (a.walk_forward, a.walk_left) == pytest.approx((forward, left), abs=1e-6)
    assert a.speed_mean == pytest.approx(np.hypot(forward, left) / 2.0, rel=1e-6)
    assert a.farthest == pytest.approx(np.hypot(forward, left), rel=1e-6)
    assert a.path_radius == pytest.approx(1000.0)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_raised_arm_is_over_its_shoulder_and_moves_most(side: str) -> None:
    a = measure(made.raised(side), FPS)
    other = "right" if side == "left" else "left"
    assert getattr(a, f"{side}_hand_over_shoulder") == pytest.approx(0.52, abs=0.02)
    assert getattr(a, f"{other}_hand_over_shoulder") == pytest.approx(-0.52, abs=0.02)
    assert getattr(a, f"{side}_hand_up_share") == pytest.approx(0.66, abs=0.06)  # sin(x) above a half
    assert a.arm_dominance == pytest.approx(1.0 if side == "left" else -1.0, abs=1e-6)
    assert a.both_hands_over_shoulder < 0
    assert a.leg_dominance == 0


@pytest.mark.parametrize("heights", [[], [0.3], [0.15, 0.4], [0.25] * 5])
def test_jumps_are_counted_and_have_their_height(heights: list[float]) -> None:
    a = measure(made.jumping(heights), FPS)
    assert a.jumps == len(heights)
    assert a.jump_height == pytest.approx(max(heights, default=0.0), abs=0.02)


def test_standing_still_is_still() -> None:
    a = measure(made.standing(), FPS)
    assert a.stillness == 1.0
    assert a.posture_names == ("standing", "standing", "standing")
    assert a.pelvis_lowest == pytest.approx(1.0, abs=0.01)
    assert (a.steps, a.jumps, a.repetitions, a.turn, a.path_length) == (0, 0, 0, 0, 0)


@pytest.mark.parametrize("low", [0.5, 0.65])
def test_sinking_between_the_feet_is_crouching(low: float) -> None:
    a = measure(made.sinking(low), FPS)
    assert a.posture_names == ("standing", "crouching", "crouching")
    assert a.pelvis_end == pytest.approx(low, abs=0.03)
    assert measure(made.sinking(low, back=True), FPS).posture_names == ("standing", "standing", "crouching")


def _turned(joints: np.ndarray, axis: int, degrees: float) -> np.ndarray:
    """Turned about a horizontal axis (0: x, 2: z) and laid on the floor."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    k, m = ((1, 2), (0, 1))[axis == 2]
    out = joints.copy()
    out[..., k], out[..., m] = joints[..., k] * c - joints[..., m] * s, joints[..., k] * s + joints[..., m] * c
    return out - [0.0, out[..., 1].min() - 0.05, 0.0]


@pytest.mark.parametrize(("axis", "degrees"), [(0, 90), (0, -90), (2, 90)])
def test_a_body_on_the_floor_lies(axis: int, degrees: float) -> None:
    assert measure(_turned(made.standing(), axis, degrees), FPS).posture_names == ("lying", "lying", "lying")


def test_a_body_on_its_hands_is_upside_down() -> None:
    a = measure(_turned(made.standing(), 2, 180), FPS)
    assert a.posture_names[2] == "upside down"
    assert a.upside_down_share == 1.0


def test_somebody_on_a_chair_sits_and_on_the_knees_kneels() -> None:
    sitting = made.sinking(0.5)[-1:].repeat(60, axis=0)
    for side in ("left", "right"):
        for name, forward in (("knee", 0.4), ("ankle", 0.4), ("foot", 0.53)):
            sitting[:, made.INDEX[f"{side}_{name}"], 2] = forward
        sitting[:, made.INDEX[f"{side}_knee"], 1] = sitting[:, made.INDEX[f"{side}_hip"], 1]
    assert measure(sitting, FPS).posture_names == ("sitting",) * 3
    kneeling = made.standing(60)
    kneeling[:, [k for name, k in made.INDEX.items() if not name.endswith(("ankle", "foot"))], 1] -= 0.42
    for side in ("left", "right"):
        for name, back in (("ankle", -0.4), ("foot", -0.5)):
            kneeling[:, made.INDEX[f"{side}_{name}"]] = kneeling[:, made.INDEX[f"{side}_knee"]] + [0, 0, back]
    assert measure(kneeling, FPS).posture_names == ("kneeling",) * 3


def test_a_bow_is_a_lean_of_its_angle() -> None:
    joints = made.standing()
    upper = [k for name, k in made.INDEX.items() if name != "pelvis" and joints[0, k, 1] > joints[0, 0, 1]]
    for k in upper:
        away = joints[0, k] - joints[0, 0]
        angle = np.radians(60)
        joints[30:60, k] = joints[0, 0] + [away[0], away[1] * np.cos(angle), away[1] * np.sin(angle)]
    a = measure(joints, FPS)
    assert a.lean_max == pytest.approx(60, abs=1.5)
    assert a.posture_names[2] == "bent"


def test_claps_and_repetitions_are_counted() -> None:
    joints, t = made.standing(151), np.arange(151) / FPS
    for side, sign in (("left", 1.0), ("right", -1.0)):
        away = 0.2 + 0.18 * np.cos(2 * np.pi * 1.0 * t)
        for name in ("wrist", "hand"):
            joints[:, made.INDEX[f"{side}_{name}"]] = np.stack([sign * away, 0 * t + 1.3, 0 * t + 0.3], axis=1)
    a = measure(joints, FPS)
    assert a.claps == 5
    assert a.repetitions == pytest.approx(5.0, abs=0.3)
    assert a.arm_dominance == pytest.approx(0.0, abs=1e-6)


def test_steps_are_counted() -> None:
    joints, t = made.standing(121), np.arange(121) / FPS
    for side, phase in (("left", 0.0), ("right", 0.5)):
        lift = np.maximum(0.12 * np.sin(2 * np.pi * (t - phase)), 0.0)
        for name in ("ankle", "foot"):
            joints[:, made.INDEX[f"{side}_{name}"], 1] += lift
    assert measure(joints, FPS).steps == pytest.approx(8, abs=1)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([20.0, 30.0, 60.0]), st.integers(1, 80))
def test_the_mirror_image_has_mirrored_attributes(seed: int, fps: float, frames: int) -> None:
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal(0, 0.04, (frames, 2)), axis=0)
    noise = np.cumsum(rng.normal(0, 0.01, (frames, 24, 3)), axis=0)
    joints = made.led(made.standing(frames) + noise, path, np.cumsum(rng.normal(0, 0.1, frames)))
    a, b = measure(joints, fps), measure(made.mirrored(joints), fps)
    assert b.row() == pytest.approx(a.mirrored().row(), abs=1e-4)
    assert np.isfinite(a.row()).all()


def test_a_motion_and_its_positions_measure_the_same() -> None:
    frames = 40
    motion = Motion(np.tile(np.eye(3, dtype=np.float32), (frames, 24, 1, 1)), np.zeros((frames, 3)), 30.0)
    assert measure(motion) == measure(motion.positions(), 30.0)


def test_a_row_gives_the_attributes_back() -> None:
    a = measure(made.circle(1.0, 90, 2), FPS)
    assert len(a.row()) == len(ATTRIBUTES)
    assert Attributes.from_row(a.row()).row() == pytest.approx(a.row())


@pytest.mark.parametrize(
    ("positions", "fps"),
    [
        (np.zeros((0, 24, 3)), 30),
        (np.zeros((5, 22, 3)), 30),
        (np.full((5, 24, 3), np.nan), 30),
        (np.zeros((5, 24, 3)), 0),
    ],
)
def test_what_cannot_be_measured_is_refused(positions: np.ndarray, fps: float) -> None:
    with pytest.raises(InvalidInputError):
        measure(positions, fps)


def test_ten_seconds_are_measured_in_milliseconds() -> None:
    joints = made.circle(2.0, 300, 10)
    times = []
    for _ in range(20):
        started = time.perf_counter()
        measure(joints, FPS)
        times.append(time.perf_counter() - started)
    assert min(times) < 0.03  # 2.5 ms on an idle core
