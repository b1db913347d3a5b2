"""Lying down on a bed: sit on its edge, lie back on its surface, get up the same way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels

from motionrt.errors import InvalidInputError, ScriptError
from motionrt.locomotion import Do, Goal, Lie, Performance, Script, SemanticCloud, Wait, WalkTo, action_keypoints
from motionrt.locomotion.lying import lie_back, lying, reversed_in_time, seat_keypoints
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.starting_poses import standing
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.transforms import heading

HIGH, WIDE, LONG = 0.5, 1.4, 2.0  # of the bed; its middle is at the origin, its head at -z


def bed(headboard: bool = True, length: float = LONG) -> SemanticCloud:
    def grid(*axes: np.ndarray) -> np.ndarray:
        return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)

    x, z = np.arange(-WIDE / 2, WIDE / 2 + 0.01, 0.05), np.arange(-length / 2, length / 2 + 0.01, 0.05)
    parts = [grid(x, np.array([HIGH]), z)]
    if headboard:
        parts.append(grid(x, np.arange(0.0, 1.0, 0.05), np.array([-length / 2 - 0.03])))
    floor = grid(np.arange(-3, 3.1, 0.2), np.array([0.0]), np.arange(-3, 3.1, 0.2))
    count = sum(map(len, parts))
    return SemanticCloud(np.concatenate([*parts, floor]), ["bed"] * count + ["floor"] * len(floor))


@pytest.fixture(scope="module")
def performance() -> Performance:
    actions = [Do("lie down on the bed", 2.0), Wait(0.5), WalkTo(2.5, 2.5)]
    models = FakeCharacterModels()
    models.standing = standing() or models.standing  # arms at its sides
    return Performer(models, Goal(2.5, -2.0), cloud=bed()).perform(actions)


def seated() -> Motion:
    """On the edge at +x, its back to the bed, thighs level and shins upright."""
    stand = FakeCharacterModels().standing
    rotations = stand.rotations.copy()
    for side in ("left", "right"):
        hip, knee = SMPL24.index(f"{side}_hip"), SMPL24.index(f"{side}_knee")
        rotations[:, hip] = axis_rotation("X", -np.pi / 2) @ rotations[:, hip]
        rotations[:, knee] = axis_rotation("X", np.pi / 2) @ rotations[:, knee]
    rotations[:, 0] = axis_rotation("Y", np.pi / 2) @ rotations[:, 0]
    return Motion(rotations.astype(np.float32), np.array([[WIDE / 2 - 0.22, HIGH + 0.15, 0.0]], np.float32), FPS)


def joints(performance: Performance, kind: str, which: int) -> np.ndarray:
    part = [each for each in performance.segments if each.kind == kind][which]
    return performance.motion[(part.start + part.end) // 2 : (part.start + part.end) // 2 + 1].positions()[0]


def test_the_body_lies_on_the_surface_with_its_head_at_the_headboard(performance: Performance) -> None:
    body = joints(performance, "hold", 1)
    named = dict(zip(SMPL24.names, body, strict=True))
    assert (body[:, 1] > HIGH + 0.03).all()
    assert (body[:, 1] < HIGH + 0.35).all()
    assert (np.abs(body[:, 0]) < WIDE / 2).all()
    assert (np.abs(body[:, 2]) < LONG / 2).all()
    assert named["head"][2] < -0.4
    assert named["left_ankle"][2] > 0.4


def test_keypoints_of_who_lies_are_met(performance: Performance) -> None:
    hold = next(each for each in performance.segments if each.kind == "hold" and each.keypoints)
    assert max(hold.miss_cm.values()) < 2.0
    assert hold.keypoints["pelvis"][1] == pytest.approx(HIGH + 0.13, abs=0.02)


def test_nothing_jumps_and_shins_pass_over_the_edge(performance: Performance) -> None:
    assert np.linalg.norm(np.diff(performance.motion.positions(), axis=0), axis=-1).max() * FPS < 6.0
    seat = seated()
    body = lie_back(seat, lying(FakeCharacterModels().standing, (0.3, HIGH, 0.0), 0.0)).positions()
    shins = body[:, [SMPL24.index(f"{side}_{name}") for side in ("left", "right") for name in ("ankle", "knee")]]
    inside = (np.abs(shins[..., 0]) < WIDE / 2 - 0.05) & (np.abs(shins[..., 2]) < LONG / 2 - 0.05)
    assert shins[..., 1][inside].min() > HIGH - 0.02


def test_who_lies_waits_lying_and_gets_up_before_walking(performance: Performance) -> None:
    assert performance.motion.root[-1, [0, 2]] == pytest.approx([2.5, 2.5], abs=0.05)
    waiting = next(each for each in performance.segments if each.name == "wait")
    heights = performance.motion.root[waiting.start : waiting.end, 1]
    np.testing.assert_allclose(heights, HIGH + 0.13, atol=0.03)


def test_the_way_up_is_the_way_down_the_other_way_round() -> None:
    stand = FakeCharacterModels().standing
    seat = Motion(stand.rotations, stand.root + np.array([0.5, -0.3, 0.0], np.float32), FPS)
    back = lie_back(seat, lying(stand, (0.0, HIGH, 0.0), 0.3))
    up = reversed_in_time(back, seat)
    assert up.frames == back.frames
    np.testing.assert_array_equal(up.root[-1], seat.root[0])
    np.testing.assert_array_equal(up.root[:-1], back.root[-2::-1])


@pytest.mark.parametrize("towards", [0.0, 1.2, -2.5])
def test_feet_point_where_they_shall(towards: float) -> None:
    pose = lying(standing() or FakeCharacterModels().standing, (1.0, HIGH, 2.0), towards)
    body = pose.positions()[0]
    way = body[SMPL24.index("left_ankle")] - body[SMPL24.index("left_shoulder")]
    assert np.arctan2(way[0], way[2]) == pytest.approx(towards, abs=0.15)
    assert float(heading(pose)[0]) == pytest.approx(towards, abs=0.01)
    np.testing.assert_allclose(body[0], [1.0, HIGH + 0.13, 2.0], atol=1e-6)


def test_one_sits_down_first_on_the_edge_with_the_back_to_the_bed() -> None:
    points, facing, stand = seat_keypoints((0.0, HIGH, 0.0), (0.7, 0.0), 0.0)
    assert facing == pytest.approx(np.pi / 2)
    assert points["pelvis"][0] < 0.7 < points["left_foot"][0] < stand[0]
    assert points["left_foot"][2] < points["right_foot"][2]  # who looks along +x has the left at -z


def test_without_a_headboard_an_end_is_taken_and_the_nearer_side() -> None:
    right, left = (action_keypoints("lie on the bed", bed(headboard=False), (x, 0.0)) for x in (2.0, -2.0))
    assert right.bed is not None
    assert left.bed is not None
    assert right.bed.edge[0] > 0 > left.bed.edge[0]
    assert abs(right.bed.at[2]) < 0.3


def test_what_is_too_short_to_lie_on_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least"):
        action_keypoints("lie down on the bed", bed(length=1.2))


def test_an_edge_that_is_too_far_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="edge"):
        Lie((0.0, HIGH, 0.0), (5.0, 0.0), 0.0)


def test_scripts_tell_where_to_lie(tmp_path: Path) -> None:
    file = tmp_path / "bed.yaml"
    file.write_text("steps:\n  - lie: {at: [0, 0.5, 0], edge: [0.7, 0], heading: 90, hold: 3}\n")
    assert Script.read(file).steps == (Lie((0.0, 0.5, 0.0), (0.7, 0.0), np.pi / 2, 3.0),)
    file.write_text("steps:\n  - lie: {at: [0, 0.5, 0], heading: 90}\n")
    with pytest.raises(ScriptError, match="edge"):
        Script.read(file)
