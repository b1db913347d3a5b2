"""Plans read from files, and what they complain about."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from motionrt.errors import ScriptError
from motionrt.motion import Motion
from motionrt.synthesis.plan import Plan

PLAN = """
timeline:
  - {text: walk forward, seconds: 3}
  - {text: wave, from: 1, to: 2.5, parts: right arm}
path:
  - {time: 3, place: [0.5, 2.5], heading: 30}
targets:
  - {time: 2, joint: right_wrist, place: [0.1, 1.3, 1.9]}
keyframes:
  - {time: 1, pose: pose.npz, place: [0, 1]}
keep:
  - {motion: pose.npz, parts: [left leg, global], spans: [[0, 1]]}
"""


def written(folder: Path, text: str, name: str = "plan.yaml") -> Path:
    pose = Motion(np.tile(np.eye(3, dtype=np.float32), (40, 24, 1, 1)), np.tile([0, 0.9, 0], (40, 1)), 20.0)
    pose.save(folder / "pose.npz")
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_plan_says_texts_and_all_kinds_of_constraints(tmp_path: Path) -> None:
    plan = Plan.read(written(tmp_path, PLAN))
    assert [row["text"] for row in plan.timeline] == ["walk forward", "wave"]  # type: ignore[index,call-overload]
    found = plan.constraints
    assert found.path[0].place == (0.5, 2.5)
    assert found.path[0].heading == 30
    assert found.targets[0].place == (0.1, 1.3, 1.9)
    assert found.keyframes[0].place == (0, 1)
    assert found.keyframes[0].pose.frames == 40
    assert found.kept[0].parts == {"left leg", "global"}
    assert found.kept[0].spans == ((0, 1),)


def test_the_same_plan_as_json_is_the_same(tmp_path: Path) -> None:
    given = {"timeline": [["walk", 3]], "path": [{"time": 1, "place": [0, 1]}]}
    plan = Plan.read(written(tmp_path, json.dumps(given), "plan.json"))
    assert list(plan.timeline) == [["walk", 3]]
    assert plan.constraints.path[0].heading is None


def test_root_paths_of_kimodo_are_at_30_fps_with_headings_from_ahead_to_the_left(tmp_path: Path) -> None:
    given = [
        {
            "type": "root2d",
            "frame_indices": [0, 90],
            "smooth_root_2d": [[0, 0], [2, 1]],
            "global_root_heading": [[1, 0], [0, 1]],
        }
    ]
    path = Plan.read(written(tmp_path, json.dumps(given))).constraints.path
    assert [(way.time, way.place) for way in path] == [(0, (0, 0)), (3, (2, 1))]
    assert [way.heading for way in path] == pytest.approx([0, 90])


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("3", "a plan has the keys"),
        ("tmeline: []", "unknown key tmeline"),
        ("path: 3", "path is a list"),
        ("path: [3]", "path: 1 is a mapping"),
        ("path: [{time: 1}]", "expected 2 numbers"),
        ("path: [{time: x, place: [0, 0]}]", "expected a number"),
        ("path: [{time: -1, place: [0, 0]}]", "time must be"),
        ("path: [{time: 1, place: [0, .nan]}]", "expected a number"),
        ("targets: [{time: 1, joint: nose, place: [0, 0, 0]}]", "nose"),
        ("keyframes: [{time: 1, pose: 3}]", "the name of a motion file"),
        ("keyframes: [{time: 1, pose: none.bvh}]", "none.bvh"),
        ("keep: [{motion: pose.npz, parts: [tail]}]", "tail"),
        ('[{"type": "fullbody"}]', "only root2d is read"),
        ('[{"type": "root2d", "frame_indices": [1], "smooth_root_2d": []}]', "as many places"),
        ("a: [", "not YAML"),
    ],
)
def test_plans_that_cannot_be_name_the_file_and_what_is_wrong(tmp_path: Path, text: str, what: str) -> None:
    with pytest.raises(ScriptError, match=what) as caught:
        Plan.read(written(tmp_path, text))
    assert "plan.yaml" in str(caught.value)


def test_a_plan_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(ScriptError, match="no such file"):
        Plan.read(tmp_path / "none.yaml")
