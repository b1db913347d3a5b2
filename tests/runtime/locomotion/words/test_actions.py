"""Keypoints of instructions in rooms whose sizes are known."""

from __future__ import annotations

import numpy as np
import pytest
from rooms import Box, room, shelf, sofa, turn_matrix

from motionrt.errors import InvalidInputError
from motionrt.locomotion.words import ActionKeypoints, action_keypoints

WALL: list[Box] = [((-3, 0, -0.35), (3, 2.5, -0.25))]


def stool(x: float, z: float) -> list[Box]:
    """0.4 m square, 0.45 m high, no backrest."""
    legs: list[Box] = [
        ((x + dx, 0, z + dz), (x + dx + 0.04, 0.4, z + dz + 0.04)) for dx in (-0.2, 0.16) for dz in (-0.2, 0.16)
    ]
    return [((x - 0.2, 0.40, z - 0.2), (x + 0.2, 0.45, z + 0.2)), *legs]


def chair(x: float, z: float) -> list[Box]:
    """Seat 0.46 m high, 0.45 m square from (x, z) on, the backrest at its low x: it faces +X."""
    return [
        ((x, 0.42, z), (x + 0.45, 0.46, z + 0.45)),
        ((x, 0.46, z), (x + 0.04, 0.9, z + 0.45)),
        ((x, 0, z), (x + 0.04, 0.42, z + 0.04)),
    ]


def degrees(angle: float) -> float:
    return float((np.rad2deg(angle) + 180) % 360 - 180)


def test_who_sits_on_a_sofa_has_the_backrest_behind_and_the_feet_on_the_floor() -> None:
    action = action_keypoints("sit on the couch", room({"sofa": sofa()}))
    assert action.name == "sit sofa"
    assert set(action.keypoints) == {"pelvis", "left_foot", "right_foot"}
    assert degrees(action.heading) == pytest.approx(0, abs=1.5)
    pelvis, left, right = (action.keypoints[name] for name in ("pelvis", "left_foot", "right_foot"))
    assert pelvis == pytest.approx([0.0, 0.45 + 0.15, 0.6 - 0.33], abs=0.03)
    assert left == pytest.approx([0.11, 0.0, pelvis[2] + 0.5], abs=0.03)
    assert right == pytest.approx([-0.11, 0.0, pelvis[2] + 0.5], abs=0.03)
    assert action.approach == pytest.approx([0.0, 0.6 + 0.45], abs=0.03)


def test_one_sits_where_one_comes_from_but_not_on_the_armrest() -> None:
    cloud = room({"sofa": sofa()})
    for x, expected in ((0.25, 0.25), (2.0, 0.7 - 0.3), (-2.0, -0.7 + 0.3)):
        action = action_keypoints("sit on the sofa", cloud, near=(x, 2.0))
        assert action.keypoints["pelvis"][0] == pytest.approx(expected, abs=0.10)


@pytest.mark.parametrize("turn", [0.3, 1.2, 2.9, -2.0])
@pytest.mark.parametrize(
    "text", ["sit on the sofa", "grab from the shelf at 1.2 m with the left hand", "stand at the shelf"]
)
def test_a_turned_and_moved_room_gives_turned_and_moved_keypoints(text: str, turn: float) -> None:
    things = {"sofa": sofa(1.5, 0.5), "shelf": shelf(-1.5, -1.0)}
    there, move = np.array([0.2, 0.0, 2.0]), np.array([5.0, 0.7, -3.0])
    plain = action_keypoints(text, room(things), near=there)
    moved = action_keypoints(text, room(things, turn, tuple(move)), near=turn_matrix(turn) @ there + move)
    assert degrees(moved.heading - plain.heading - turn) == pytest.approx(0, abs=2)
    for joint, point in plain.keypoints.items():
        assert moved.keypoints[joint] == pytest.approx(turn_matrix(turn) @ point + move, abs=0.06)


def test_a_chair_is_sat_on_with_its_back_behind() -> None:
    action = action_keypoints("sit on the chair", room({"chair": chair(1.0, 1.0)}))
    assert degrees(action.heading) == pytest.approx(90, abs=1.5)
    pelvis = action.keypoints["pelvis"]
    assert pelvis[1] == pytest.approx(0.46 + 0.15, abs=0.03)
    assert 1.04 + 0.1 < pelvis[0] < 1.35
    assert pelvis[2] == pytest.approx(1.225, abs=0.04)


def test_before_a_table_one_comes_to_a_chair_from_its_side() -> None:
    table: list[Box] = [((1.7, 0.7, 0.6), (2.6, 0.74, 1.9))]
    action = action_keypoints("sit on the chair", room({"chair": chair(1.0, 1.0), "table": table}))
    assert degrees(action.heading) == pytest.approx(90, abs=1.5)
    assert not 0.8 < action.approach[1] < 1.65


@pytest.mark.parametrize(("near", "heading"), [((0, 2), 0), ((2, 0), 90), ((-2, 0), -90), ((0, -2), 180)])
def test_a_stool_is_sat_on_from_where_one_comes(near: tuple[float, float], heading: float) -> None:
    action = action_keypoints("sit on the stool", room({"stool": stool(0, 0)}), near)
    assert degrees(action.heading - np.deg2rad(heading)) == pytest.approx(0, abs=2)


def test_a_stool_against_a_wall_is_sat_on_away_from_it() -> None:
    cloud = room({"stool": stool(0, 0), "wall": WALL})
    assert abs(degrees(action_keypoints("sit on the stool", cloud, near=(0, 2)).heading)) < 2
    assert abs(degrees(action_keypoints("sit on the stool", cloud, near=(0, -2)).heading)) < 95  # not into the wall


def test_what_is_flat_and_low_or_high_is_no_seat() -> None:
    lamp: list[Box] = [((0, 0, 0), (0.1, 1.6, 0.1))]
    with pytest.raises(InvalidInputError, match="nothing to sit on: no surface between 25 and 75 cm"):
        action_keypoints("sit on the lamp", room({"lamp": lamp}))


def test_who_grabs_from_a_shelf_stands_before_its_open_side_and_faces_it() -> None:
    action = action_keypoints("grab from the shelf at 1.2 m", room({"shelf": shelf(), "wall": WALL}))
    assert set(action.keypoints) == {"right_hand", "left_foot", "right_foot"}
    hand, left, right = (action.keypoints[name] for name in ("right_hand", "left_foot", "right_foot"))
    assert hand == pytest.approx([0.0, 1.2, 0.3], abs=0.03)
    assert abs(degrees(action.heading)) == pytest.approx(180, abs=1.5)  # looks along -Z
    assert left[0] < right[0]  # so its left is -X
    assert left[1] == right[1] == 0
    assert 0.4 <= left[2] - hand[2] <= 0.5
    assert left[0] < (left[0] + right[0]) / 2 < hand[0]  # the right hand is to the right of the middle
    assert action.approach[1] > left[2]


def test_the_left_hand_is_taken_when_asked_for() -> None:
    action = action_keypoints("grab from the shelf at 0.8 m with the left hand", room({"shelf": shelf(), "wall": WALL}))
    assert "left_hand" in action.keypoints
    middle = (action.keypoints["left_foot"][0] + action.keypoints["right_foot"][0]) / 2
    assert middle > action.keypoints["left_hand"][0]


@pytest.mark.parametrize(
    ("height", "least", "most"), [(0.2, 0.3, 0.5), (1.2, 0.4, 0.5), (1.6, 0.2, 0.4), (2.0, 0.1, 0.3)]
)
def test_the_higher_the_hand_the_nearer_one_stands(height: float, least: float, most: float) -> None:
    cloud = room({"cupboard": [((-0.5, 0, 0), (0.5, 2.1, 0.3))], "wall": WALL})
    action = action_keypoints(f"touch the cupboard at {height} m", cloud)
    assert action.keypoints["right_hand"][1] == pytest.approx(height)
    assert least < action.keypoints["right_foot"][2] - action.keypoints["right_hand"][2] < most


def test_a_height_that_the_shelf_does_not_have_is_refused_with_those_it_has() -> None:
    with pytest.raises(InvalidInputError, match=r"the shelf has nothing at 2.60 m; grab at 0.00 to 2.02 m"):
        action_keypoints("grab from the shelf at 2.6 m", room({"shelf": shelf()}))


def test_a_wall_is_touched_where_one_comes_from() -> None:
    action = action_keypoints("touch the wall with the left hand", room({"wall": WALL}), near=(-1.5, 1.0))
    assert action.keypoints["left_hand"] == pytest.approx([-1.5, 1.1, -0.25], abs=0.05)
    assert abs(degrees(action.heading)) == pytest.approx(180, abs=2)


def test_a_lamp_on_a_table_is_reached_from_outside_the_table() -> None:
    things: dict[str, list[Box]] = {
        "table": [((-0.6, 0.70, -0.4), (0.6, 0.74, 0.4))],
        "lamp": [((-0.05, 0.74, -0.05), (0.05, 1.1, 0.05))],
    }
    action = action_keypoints("reach the lamp", room(things), near=(0, 2))
    assert action.keypoints["right_hand"] == pytest.approx([0, 0.92, 0.05], abs=0.06)
    assert action.approach[1] > 0.4 + 0.15
    taken = action_keypoints("take the lamp from the table", room(things), near=(0, 2))
    assert taken.name == "grab lamp"
    np.testing.assert_array_equal(taken.keypoints["right_hand"], action.keypoints["right_hand"])


def test_who_stands_at_a_thing_faces_it_and_keeps_clear_of_it() -> None:
    action = action_keypoints("stand at the shelf", room({"shelf": shelf(), "wall": WALL}))
    assert abs(degrees(action.heading)) == pytest.approx(180, abs=2)
    assert action.keypoints["pelvis"] == pytest.approx([0.0, 0.94, 0.7], abs=0.05)
    assert action.keypoints["left_foot"][2] - 0.3 > 0.2


def nearest(action: ActionKeypoints, places: list[tuple[float, float]]) -> int:
    pelvis = action.keypoints["pelvis"][[0, 2]]
    return int(np.argmin([np.linalg.norm(pelvis - place) for place in places]))


def test_of_several_chairs_the_nearest_is_taken() -> None:
    places = [(-2.0, -2.0), (2.0, -2.0), (0.0, 2.0)]
    cloud = room({"stool": [box for place in places for box in stool(*place)]})
    assert len(cloud.instances("stool")) == 3
    for i, (x, z) in enumerate(places):
        assert nearest(action_keypoints("sit on the stool", cloud, near=(0.6 * x, 0.6 * z)), places) == i


def test_an_unknown_object_is_refused_with_the_labels_there_are() -> None:
    with pytest.raises(InvalidInputError, match="no 'throne' in the scene; it has: floor, shelf, sofa"):
        action_keypoints("sit on the throne", room({"sofa": sofa(), "shelf": shelf(2, 2)}))


@pytest.mark.parametrize("near", [(1,), (0, 1, 2, 3), (np.nan, 0), ((0, 0), (1, 1))])
def test_a_place_that_is_none_is_refused(near: tuple[float, ...]) -> None:
    with pytest.raises(InvalidInputError, match="near must be"):
        action_keypoints("sit on the sofa", room({"sofa": sofa()}), near)


DOOR: list[Box] = [((-0.45, 0, -0.04), (0.45, 2.0, 0.0))]
TABLE: list[Box] = [((-0.6, 0.74, -0.4), (0.6, 0.78, 0.4))]


def test_a_door_is_opened_where_its_handle_is_unless_a_height_is_told() -> None:
    cloud = room({"door": DOOR})
    for text, height in (("open the door", 1.0), ("open the door at 1.3 m", 1.3), ("close the door", 1.0)):
        hand = action_keypoints(text, cloud, near=(0, 2)).keypoints["right_hand"]
        assert hand[1] == pytest.approx(height, abs=0.01)
        assert hand[2] == pytest.approx(0.0, abs=0.03)


def test_who_leans_has_both_hands_on_the_surface_and_the_feet_farther_away_than_for_a_grip() -> None:
    cloud = room({"table": TABLE})
    lean, touch = (action_keypoints(f"{verb} the table", cloud, near=(0, 2)) for verb in ("lean on", "touch"))
    for hand in ("left_hand", "right_hand"):
        assert lean.keypoints[hand][1] == pytest.approx(0.76, abs=0.03)
    assert lean.keypoints["left_hand"][0] < lean.keypoints["right_hand"][0]  # who faces -Z has the left at -X
    assert lean.keypoints["left_foot"][2] > touch.keypoints["left_foot"][2] + 0.05


def test_who_looks_at_something_stays_and_faces_it() -> None:
    look = action_keypoints("look at the door", room({"door": DOOR}), near=(2.0, 2.0))
    assert look.heading == pytest.approx(np.arctan2(-2.0, -2.0), abs=0.02)
    assert look.keypoints["pelvis"][[0, 2]] == pytest.approx([2.0, 2.0], abs=0.01)
    assert look.approach == pytest.approx([2.0, 2.0], abs=0.01)
