"""Feet on slopes and stairs: each stands on the ground under itself, stays there, and swings over edges."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels

from motionrt.locomotion import Goal, Scene, WalkTo
from motionrt.locomotion.goal_frame import uncanonicalise
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.starting_poses import standing
from motionrt.locomotion.stepping import step_to
from motionrt.locomotion.terrain import raised, smoothed
from motionrt.locomotion.uneven import feet_on_ground, surface_gaps
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.lock import planted_toes

Under = Callable[[np.ndarray], np.ndarray]
TOES = [SMPL24.index(f"{side}_foot") for side in ("left", "right")]
ANKLES = [SMPL24.index(f"{side}_ankle") for side in ("left", "right")]
RISE, TREAD = 0.15, 0.45


def ramp(degrees: float) -> Under:
    return lambda places: np.tan(np.radians(degrees)) * np.asarray(places)[..., 1]


def stairs(places: np.ndarray) -> np.ndarray:
    return RISE * np.clip(np.floor((np.asarray(places)[..., 1] - 0.4) / TREAD) + 1, 0, 6)


def noisy(places: np.ndarray) -> np.ndarray:
    """A gentle slope as a scanner sees it: steps of a cell that are off by a centimetre."""
    cells = np.floor(np.asarray(places) / 0.05).astype(int)
    noise = np.sin(12.9898 * cells[..., 0] + 78.233 * cells[..., 1]) * 43758.5453
    return 0.1 * np.asarray(places)[..., 1] + 0.01 * (2 * (noise - np.floor(noise)) - 1)


GROUNDS = {"up 10": ramp(10), "down 10": ramp(-10), "up 20": ramp(20), "stairs": stairs, "noisy": noisy}


def walked(under: Under) -> tuple[Motion, Motion, np.ndarray, np.ndarray]:
    """Two and a half metres of steps: raised alone, with feet on the ground, when they surely stand, the ground."""
    stand = standing() or FakeCharacterModels().standing
    plane = step_to(stand, uncanonicalise(stand, Goal(0.0, 2.5))).motion
    ground = smoothed(under(plane.root[:, [0, 2]]).astype(np.float64))
    planted, before = planted_toes(plane), raised(plane, ground)
    after = feet_on_ground(before, planted, ground, under)
    return before, after, planted & np.roll(planted, -1, axis=0) & np.roll(planted, 1, axis=0), ground


@pytest.mark.parametrize("name", GROUNDS)
def test_standing_feet_are_on_the_ground_under_them(name: str) -> None:
    under = GROUNDS[name]
    before, after, planted, _ = walked(under)
    worst = np.abs(surface_gaps(after, planted, under)).max()
    assert np.abs(surface_gaps(before, planted, under)).max() > 0.02
    assert worst < (0.025 if name == "noisy" else 0.01)


@pytest.mark.parametrize("name", GROUNDS)
def test_feet_do_not_slide_and_nothing_jumps(name: str) -> None:
    before, after, planted, _ = walked(GROUNDS[name])
    both = planted[1:] & planted[:-1]
    slides = np.linalg.norm(np.diff(after.positions()[:, TOES], axis=0), axis=-1)[both]
    assert slides.max() < 0.006
    steps = np.linalg.norm(np.diff(after.positions(), axis=0), axis=-1).max() * FPS
    assert steps < np.linalg.norm(np.diff(before.positions(), axis=0), axis=-1).max() * FPS + 3.0
    assert np.abs(np.diff(after.root[:, 1])).max() * FPS < 1.0


def test_no_foot_goes_through_the_edges_of_steps() -> None:
    before, after, _, _ = walked(stairs)

    def lowest(motion: Motion) -> float:
        toes = motion.positions()[:, TOES]
        return float((toes[..., 1] - stairs(toes[..., [0, 2]])).min())

    assert lowest(before) < -0.05
    assert lowest(after) > -0.015


def test_feet_are_pitched_as_the_slope_is() -> None:
    _, after, planted, _ = walked(ramp(15))
    flat, _, _, _ = walked(ramp(0.0))

    def pitch(motion: Motion) -> np.ndarray:
        joints = motion.positions()
        way = joints[:, TOES] - joints[:, ANKLES]
        return np.degrees(np.arctan2(way[..., 1], np.hypot(way[..., 0], way[..., 2])))[planted]

    assert np.median(pitch(after)) - np.median(pitch(flat)) == pytest.approx(15, abs=1.5)


def test_flat_ground_changes_nothing() -> None:
    before, after, _, _ = walked(lambda places: np.full(np.asarray(places).shape[:-1], 1.5))
    assert after is before


def test_where_there_is_no_ground_feet_stay_as_they_are() -> None:
    before, after, planted, _ = walked(ramp(10))
    nowhere = feet_on_ground(before, planted, np.zeros(before.frames), lambda places: np.full(len(places), np.nan))
    assert nowhere is before
    assert after is not before


def test_a_performance_on_a_scene_puts_feet_on_its_ground() -> None:
    pytest.importorskip("scipy")
    z, high = [-2.0, 1.0, 5.0, 9.0], [0.0, 0.0, 0.8, 0.8]
    vertices = [(x, y, at) for y, at in zip(high, z, strict=True) for x in (-2.0, 2.0)]
    faces = [face for i in (0, 2, 4) for face in ((i, i + 2, i + 1), (i + 1, i + 2, i + 3))]
    scene = Scene.from_mesh((vertices, faces))
    models = FakeCharacterModels()
    models.standing = standing() or models.standing
    done = Performer(models, Goal(0, 1.5), scene).perform([WalkTo(0.0, 3.0, 0.0)])
    plane = raised(done.motion, -done.ground)
    planted = planted_toes(plane)
    planted &= np.roll(planted, -1, axis=0)
    gaps = surface_gaps(done.motion, planted, lambda places: scene.height(places).astype(np.float64))
    assert np.percentile(np.abs(gaps), 95) < 0.02
