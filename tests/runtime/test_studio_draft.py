"""Clicks that become a script, and the script that motionrt perform reads."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Act, Do, Follow, Goal, Scene, Script, Stand, Wait, WalkTo
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.script_scene import SceneSpec
from motionrt.studio import draft as drafts
from motionrt.studio.draft import Draft, Options
from motionrt.studio.postures import grab, sit
from motionrt.studio.script_text import script_text

ROOM = SceneSpec(floor=(((-1.0, -1.0), (6.0, -1.0), (6.0, 6.0), (-1.0, 6.0)),), agent={"radius": 0.25})
GROUND = Options()


def clicks(*given: tuple[str, tuple[float, float, float]], options: Options = GROUND) -> Draft:
    draft = Draft()
    for tool, point in given:
        draft = draft.clicked(tool, point, options)
    return draft


def test_a_click_with_walk_is_a_step_and_the_next_one_another() -> None:
    draft = clicks((drafts.WALK, (1.0, 0.0, 2.0)), (drafts.WALK, (3.0, 0.0, 2.0)))
    assert draft.steps == (WalkTo(1.0, 2.0), WalkTo(3.0, 2.0))
    assert draft.place == (3.0, 2.0)


def test_a_path_grows_by_clicks_and_is_done_with_the_next_tool() -> None:
    draft = clicks((drafts.PATH, (1, 0, 1)), (drafts.PATH, (2, 0, 1)), (drafts.PATH, (2, 0, 3)))
    assert draft.steps == ()
    (follow,) = draft.actions
    assert isinstance(follow, Follow)
    np.testing.assert_allclose(follow.path.points, [[1, 1], [2, 1], [2, 3]])
    then = draft.clicked(drafts.WALK, (0, 0, 0), GROUND)
    assert [type(step) for step in then.steps] == [Follow, WalkTo]
    assert then.path == ()


def test_a_path_of_one_point_is_no_step() -> None:
    assert clicks((drafts.PATH, (1, 0, 1))).finished().steps == ()


def test_one_click_sits_down_facing_where_one_came_from() -> None:
    (step,) = clicks((drafts.SIT, (0.0, 0.42, 3.0))).steps
    assert isinstance(step, Act)
    assert abs(step.heading or 0) == pytest.approx(math.pi)  # came along +Z, so faces -Z
    assert step.keypoints["pelvis"][1] == pytest.approx(0.55)
    assert step.keypoints["left_foot"][2] < 3.0
    assert step.keypoints["left_foot"][0] < 0 < step.keypoints["right_foot"][0]  # who faces -Z has the left towards -X
    assert step.approach == pytest.approx((0.0, 2.38))


def test_a_seat_that_is_only_ground_has_the_usual_height() -> None:
    assert sit((0, 0, 3), (0, 0), 0.45, 2, None).keypoints["pelvis"][1] == pytest.approx(0.58)


@given(st.floats(-3, 3), st.floats(1, 4), st.sampled_from(["left", "right"]))
def test_one_click_grabs_from_the_side_one_came_from(x: float, z: float, side: str) -> None:
    step = grab((x, 1.2, z), (0.0, 0.0), side, 1.0, 2.0)
    assert step.keypoints[f"{side}_hand"] == pytest.approx((x, 1.2, z), abs=6e-4)
    feet = np.mean([step.keypoints["left_foot"], step.keypoints["right_foot"]], axis=0)
    assert math.hypot(feet[0], feet[2]) < math.hypot(x, z)
    ahead = math.atan2(x - feet[0], z - feet[2])
    assert math.remainder(ahead - (step.heading or 0), 2 * math.pi) == pytest.approx(0, abs=0.01)


def test_who_cannot_stand_there_stands_on_the_next_free_side() -> None:
    wall = Scene.from_polygons(
        [[(-3, -3), (3, -3), (3, 3), (-3, 3)]], [[(-0.2, -0.9), (0.2, -0.9), (0.2, 0.2), (-0.2, 0.2)]]
    )
    step = grab((0.0, 1.0, 0.0), (0.0, -3.0), "right", 1.0, 2.0, lambda place: bool(wall.free(place)))
    feet = np.mean([step.keypoints["left_foot"], step.keypoints["right_foot"]], axis=0)
    assert wall.free(feet[[0, 2]])


def test_joints_gather_in_one_pose_until_one_repeats() -> None:
    draft = Draft()
    for joint in ("right_hand", "left_foot", "right_foot", "right_hand"):
        draft = draft.clicked(drafts.JOINT, (0.3, 1.0, 2.0), Options(joint=joint))
    first, second = draft.steps
    assert isinstance(first, Act)
    assert isinstance(second, Act)
    assert list(first.keypoints) == ["right_hand", "left_foot", "right_foot"]
    assert list(second.keypoints) == ["right_hand"]
    assert draft.keypoints == 4


def test_the_start_keeps_its_heading_when_it_is_moved() -> None:
    draft = Draft(Goal(0, 0, 1.0)).clicked(drafts.START, (2, 0, 3), GROUND)
    assert draft.start == Goal(2, 3, 1.0)


def test_a_keypoint_can_be_dragged() -> None:
    draft = clicks((drafts.SIT, (0, 0.42, 3))).moved(0, "pelvis", (0.1, 0.6, 3.0))
    assert isinstance(draft.steps[0], Act)
    assert draft.steps[0].keypoints["pelvis"] == (0.1, 0.6, 3.0)
    with pytest.raises(InvalidInputError, match="step 1 has no keypoint 'head'"):
        draft.moved(0, "head", (0, 0, 0))


def test_unknown_tools_and_joints_are_typed_errors() -> None:
    with pytest.raises(InvalidInputError, match="unknown tool 'Fly'"):
        clicks(("Fly", (0, 0, 0)))
    with pytest.raises(InvalidInputError, match="no joint 'tail'"):
        clicks((drafts.JOINT, (0, 0, 0)), options=Options(joint="tail"))


def test_a_script_of_everything_is_read_back_as_it_was(tmp_path: Path) -> None:
    draft = clicks(
        (drafts.START, (0.5, 0.0, 0.25)),
        (drafts.WALK, (2.0, 0.0, 1.0)),
        (drafts.PATH, (3.0, 0.0, 1.0)),
        (drafts.PATH, (3.0, 0.0, 4.0)),
        (drafts.SIT, (4.0, 0.42, 4.0)),
        (drafts.GRAB_LEFT, (5.0, 1.3, 2.0)),
    ).added(Stand(1.0))
    draft = draft.added(Wait(0.5)).added(Do("sit on the sofa", 3.0))
    (tmp_path / "cloud.csv").write_text("x,y,z,label\n0,0,0,floor\n", encoding="utf-8")
    file = tmp_path / "script.yaml"
    text = script_text(draft.steps, draft.start, ROOM, tmp_path / "cloud.csv", speed=1.4, seed=7)
    file.write_text(text, encoding="utf-8")
    read = Script.read(file)
    assert read.start == draft.start
    assert (read.speed, read.seed, read.cloud) == (1.4, 7, tmp_path / "cloud.csv")
    assert read.scene == ROOM
    assert len(read.steps) == len(draft.steps)
    for ours, theirs in zip(draft.steps, read.steps, strict=True):
        assert type(ours) is type(theirs)
        assert drafts.described(ours) == drafts.described(theirs)
        if isinstance(ours, Act):
            assert isinstance(theirs, Act)
            assert {k: tuple(v) for k, v in theirs.keypoints.items()} == dict(ours.keypoints)
            assert math.remainder((theirs.heading or 0) - (ours.heading or 0), 2 * math.pi) == pytest.approx(
                0, abs=1e-4
            )


def test_a_script_of_a_map_names_its_file(tmp_path: Path) -> None:
    file = tmp_path / "größe.pgm"
    file.write_bytes(b"P5 2 2 255\n\xff\xff\xff\xff")
    out = tmp_path / "s.yaml"
    out.write_text(script_text([WalkTo(1, 1)], Goal(0, 0), SceneSpec(file=file, options={"resolution": 0.5})), "utf-8")
    assert Script.read(out).scene == SceneSpec(file=file, options={"resolution": 0.5})


def test_what_was_clicked_can_be_performed() -> None:
    draft = clicks((drafts.WALK, (0.0, 0.0, 2.0)), (drafts.SIT, (0.0, 0.42, 4.0)), (drafts.WALK, (2.0, 0.0, 2.0)))
    performance = Performer(FakeCharacterModels(), draft.start).perform(draft.steps)
    assert [s.name for s in performance.segments if s.kind == "hold" and s.keypoints] == ["sit"]
