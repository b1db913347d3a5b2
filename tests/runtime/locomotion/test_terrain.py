"""Ground that is not flat: feet on it, poses where their keypoints are."""

from __future__ import annotations

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels

from motionrt.locomotion import Act, Do, Goal, Scene, SemanticCloud, WalkTo
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.terrain import Terrain, raised
from motionrt.motion import Motion

UP = 2.0


def ramp() -> Scene:
    """6 m at height 2, then a slope down to 1 over 4 m, then 6 m of that."""
    z = [-1.0, 6.0, 10.0, 16.0]
    heights = [UP, UP, UP - 1, UP - 1]
    vertices = [(x, y, z) for y, z in zip(heights, z, strict=True) for x in (-2.0, 2.0)]
    faces = [face for i in (0, 2, 4) for face in ((i, i + 2, i + 1), (i + 1, i + 2, i + 3))]
    return Scene.from_mesh((vertices, faces))


@pytest.fixture(scope="module")
def scene() -> Scene:
    pytest.importorskip("scipy")
    return ramp()


def test_heights_are_those_of_the_scene_and_go_on_where_there_is_none(scene: Scene) -> None:
    terrain = Terrain(scene)
    assert terrain.at((0, 2)) == pytest.approx(UP, abs=0.02)
    assert terrain.at((0, 8)) == pytest.approx(UP - 0.5, abs=0.1)
    assert terrain.at((50, 50), 7.0) == 7.0
    np.testing.assert_allclose(terrain.under(np.array([[0, 2], [50, 2], [0, 12]])), [UP, UP, UP - 1], atol=0.02)
    assert Terrain(None, 5.0).at((3, 4)) == 5.0
    assert Terrain(None).at((3, 4)) == 0.0


def test_flat_ground_at_zero_changes_nothing() -> None:
    motion = FakeCharacterModels().stride
    assert raised(motion, np.zeros(motion.frames)) is motion


def test_a_walk_stays_on_the_ground(scene: Scene) -> None:
    done = Performer(FakeCharacterModels(), Goal(0, 0), scene).perform([WalkTo(0, 14)], foot_lock=False)
    standing = FakeCharacterModels().standing.root[0, 1]
    over = done.motion.root[:, 1] - scene.height(done.motion.root[:, [0, 2]])
    assert done.motion.root[0, 1] == pytest.approx(UP + standing, abs=0.03)
    assert done.motion.root[-1, 1] == pytest.approx(UP - 1 + standing, abs=0.03)
    assert np.abs(over - standing).max() < 0.3  # the slope begins and ends within transitions, too
    assert np.abs(np.diff(done.motion.root[:, 1])).max() < 0.03
    np.testing.assert_allclose(done.motion.root[:, 1] - done.ground, standing, atol=0.07)  # straight legs sink in steps
    flat = Performer(FakeCharacterModels(), Goal(0, 0)).perform([WalkTo(0, 14)], foot_lock=False)
    assert done.measures.motion.foot_skate_cm == pytest.approx(flat.measures.motion.foot_skate_cm, rel=0.05)


def test_keypoints_are_met_in_the_world(scene: Scene) -> None:
    reach = Act({"right_hand": (0.3, UP + 1.2, 4.5)}, heading=0.0)
    done = Performer(FakeCharacterModels(), Goal(0, 0), scene).perform([reach], foot_lock=False)
    assert done.segments[-1].miss_cm["right_hand"] < 1.0
    assert isinstance(done.motion, Motion)
    assert done.segments[-2].end_cm == pytest.approx(0, abs=0.01)


def test_a_motion_on_high_ground_is_gone_on_from_there(scene: Scene) -> None:
    before = raised(FakeCharacterModels().stride, np.full(60, UP))
    done = Performer(FakeCharacterModels(), before, scene).perform([WalkTo(0, 4)], foot_lock=False)
    assert done.segments[0].kind == "walk"
    assert done.motion.root[0, 1] == pytest.approx(before.root[-1, 1], abs=0.03)


def test_words_are_understood_on_the_floor_of_their_cloud() -> None:
    seat = np.stack(np.meshgrid(np.arange(-0.4, 0.4, 0.05), [1.45], np.arange(4, 4.6, 0.05)), axis=-1).reshape(-1, 3)
    floor = np.stack(np.meshgrid(np.arange(-3, 3, 0.2), [1.0], np.arange(-1, 7, 0.2)), axis=-1).reshape(-1, 3)
    cloud = SemanticCloud(np.concatenate([seat, floor]), ["stool"] * len(seat) + ["floor"] * len(floor))
    done = Performer(FakeCharacterModels(), Goal(0, 0), cloud=cloud).perform([Do("sit on the stool")], foot_lock=False)
    assert done.motion.root[0, 1] == pytest.approx(1.0 + FakeCharacterModels().standing.root[0, 1], abs=1e-4)
    assert done.segments[-1].miss_cm["pelvis"] < 0.01
    np.testing.assert_allclose(done.segments[-1].keypoints["pelvis"][1], 1.6, atol=0.03)
