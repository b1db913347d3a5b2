"""Scripts: what is read, and how every slip is told."""

from __future__ import annotations

import math
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import ScriptError
from motionrt.locomotion import Act, Do, Follow, Generate, Goal, Script, Stand, Wait, WalkTo
from motionrt.locomotion.script_scene import SceneSpec
from motionrt.motion import SMPL24

FULL = """\
# A visit
scene:
  floor: [[[-2, -2], [12, -2], [12, 12], [-2, 12]]]
  obstacles:
    - [[4, 4], [6, 4], [6, 6], [4, 6]]
  radius: 0.3
  cell: 0.1
cloud: room.csv
start: {at: [1, 2], heading: 90}
speed: 1.1
seed: 7
foot_lock: false
steps:
  - walk: {to: [5, 2]}
  - walk: {to: [8, 8], heading: -90}
  - walk: {path: route.csv}
  - walk: {path: [[0, 0], [3, 0.5]], heading: 180}
  - act:
      name: sit
      keypoints: {pelvis: [2, 0.5, 3], left_foot: [2.1, 0, 3.4]}
      heading: 45
      hold: 3
      approach: [2, 4]
  - act: {keypoints: {right_hand: [2, 1.2, 3]}}
  - do: sit on the sofa
  - do: {text: grab from the shelf at 1.2 m, hold: 0.5}
  - stand:
  - stand: 1.5
  - wait: 2
  - hold: 0
"""


@pytest.fixture
def folder(tmp_path: FilePath) -> FilePath:
    (tmp_path / "route.csv").write_text("x,z\n0,0\n0,4\n", encoding="utf-8")
    (tmp_path / "room.csv").write_text("x,y,z,label\n0,0,0,floor\n", encoding="utf-8")
    (tmp_path / "map.pgm").write_bytes(b"P5 4 4 255\n" + bytes([254] * 16))
    return tmp_path


def read(folder: FilePath, text: str) -> Script:
    (folder / "script.yaml").write_text(text, encoding="utf-8")
    return Script.read(folder / "script.yaml")


def test_everything_that_a_script_may_say_is_read(folder: FilePath) -> None:
    script = read(folder, FULL)
    assert script.start == Goal(1, 2, math.pi / 2)
    assert (script.speed, script.seed, script.foot_lock) == (1.1, 7, False)
    assert script.cloud == folder / "room.csv"
    assert script.scene == SceneSpec(
        floor=(((-2, -2), (12, -2), (12, 12), (-2, 12)),),
        obstacles=(((4, 4), (6, 4), (6, 6), (4, 6)),),
        options={"cell": 0.1},
        agent={"radius": 0.3},
    )
    to, facing, follow, points, sit, reach, words, grab, stand, longer, wait, hold = script.steps
    assert to == WalkTo(5, 2)
    assert facing == WalkTo(8, 8, -math.pi / 2)
    assert isinstance(follow, Follow)
    np.testing.assert_array_equal(follow.path.points, [[0, 0], [0, 4]])
    assert isinstance(points, Follow)
    assert points.heading == pytest.approx(math.pi)
    np.testing.assert_allclose(points.path.points, [[0, 0], [3, 0.5]])
    keypoints = {"pelvis": (2, 0.5, 3), "left_foot": (2.1, 0, 3.4)}
    assert sit == Act(keypoints, math.pi / 4, 3.0, (2, 4), "sit")
    assert reach == Act({"right_hand": (2, 1.2, 3)})
    assert (words, grab) == (Do("sit on the sofa"), Do("grab from the shelf at 1.2 m", 0.5))
    assert (stand, longer, wait, hold) == (Stand(), Stand(1.5), Wait(2), Wait(0))


def test_the_scene_of_a_script_opens(folder: FilePath) -> None:
    spec = read(folder, FULL).scene
    assert spec is not None
    scene = spec.open()
    assert scene.agent.radius == 0.3
    assert scene.free([1, 1])
    assert not scene.free([5, 5])


def test_a_scene_may_be_a_file_beside_the_script(folder: FilePath) -> None:
    steps = "steps: [{wait: 1}]\n"
    assert read(folder, "scene: map.pgm\n" + steps).scene == SceneSpec(file=folder / "map.pgm")
    with_options = read(folder, "scene: {file: map.pgm, resolution: 0.5, comfort: 0.5}\n" + steps).scene
    assert with_options == SceneSpec(file=folder / "map.pgm", options={"resolution": 0.5}, agent={"comfort": 0.5})
    assert with_options is not None
    assert with_options.open().grid.cell == 0.5


def test_only_steps_are_needed(folder: FilePath) -> None:
    script = read(folder, "\ufeffsteps:\r\n- walk: {to: [1, 2]}\r\n")
    assert script == Script(folder / "script.yaml", (WalkTo(1, 2),), Goal(0, 0))


numbers = st.floats(-50, 50, allow_nan=False).map(lambda x: round(x, 4))
seconds = st.floats(0, 30).map(lambda x: round(x, 3))
degrees = st.floats(-360, 360).map(lambda x: round(x, 2))


@st.composite
def steps(draw: st.DrawFn) -> tuple[dict[str, Any], Any]:
    """A step as YAML holds it, and the action that it means."""
    kind = draw(st.sampled_from(["walk", "act", "stand", "wait"]))
    if kind == "walk":
        x, z, heading = draw(numbers), draw(numbers), draw(st.none() | degrees)
        told = {"to": [x, z]} | ({} if heading is None else {"heading": heading})
        return {"walk": told}, WalkTo(x, z, None if heading is None else math.radians(heading))
    if kind == "act":
        points = draw(st.dictionaries(st.sampled_from(SMPL24.names), st.tuples(numbers, numbers, numbers), min_size=1))
        hold, name = draw(seconds), draw(st.text("abc äß:#'\"-", min_size=1).filter(str.strip))
        told = {"keypoints": {joint: list(point) for joint, point in points.items()}, "hold": hold, "name": name}
        return {"act": told}, Act(points, None, hold, None, name.strip())
    time = draw(seconds)
    return ({"stand": time}, Stand(time)) if kind == "stand" else ({"wait": time}, Wait(time))


@given(st.lists(steps(), min_size=1, max_size=5), st.booleans())
def test_what_yaml_writes_comes_back(told: list[tuple[dict[str, Any], Any]], flow: bool) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as name:
        text = yaml.safe_dump({"steps": [step for step, _ in told]}, allow_unicode=True, default_flow_style=flow)
        script = read(FilePath(name), text)
    assert script.steps == tuple(action for _, action in told)


BAD = {
    "- sitt: {}": r"script\.yaml:2: step 1: unknown action 'sitt'; there are: walk, act, lie, do",
    "- stans: 1": r"script\.yaml:2: step 1: unknown action 'stans'; did you mean stand\?",
    "- wait: 1\n- wlak: {to: [1, 2]}": r"script\.yaml:3: step 2: unknown action 'wlak'; did you mean walk\?",
    "- walk": r"step 1: action 'walk' stands alone; write it with a colon",
    "- dance": r"step 1: action 'dance'; there are: .* Write it with a colon",
    "- 7": r"step 1: expected one action",
    "- {wait: 1, stand: 1}": r"step 1: expected one action",
    "- walk: {to: [1, 2], headng: 3}": r"step 1 \(walk\): unknown key 'headng'; did you mean heading\?",
    "- walk: {}": r"either to: \[x, z\] or path:",
    "- walk: {to: [1, 2], path: route.csv}": r"either to: \[x, z\] or path:",
    "- walk: [1, 2]": r"step 1 \(walk\): expected to, path or heading, found a list of 2",
    "- walk: {to: [1, 2, 3]}": r"step 1 \(walk\): to: expected 2 numbers, as in \[x, z\] in metres; found 3",
    "- walk: {to: [1, two]}": r"to: expected a number \(metres\), found 'two'",
    "- walk: {to: 4}": r"to: expected 2 numbers, as in \[x, z\] in metres; found '4'",
    "- walk: {to: [1, .nan]}": r"expected a number \(metres\), found 'nan'",
    "- walk: {to: [1, true]}": r"expected a number \(metres\), found true",
    "- walk: {to: [1, 2], heading: north}": r"heading: expected a number \(degrees\), found 'north'",
    "- walk: {path: nowhere.csv}": r"path: there is no file .*nowhere\.csv \(names are relative to the script\)",
    "- walk: {path: [[0, 0]]}": r"path: a path needs at least two different points",
    "- walk: {path: [0, 0]}": r"path: expected 2 numbers",
    "- act: {name: sit}": r"step 1 \(act\): 'keypoints' is missing",
    "- act: {keypoints: {}}": r"keypoints: expected joints and places",
    "- act: {keypoints: {rigth_hand: [0, 1, 2]}}": r"unknown key 'rigth_hand'; did you mean right_hand\?",
    "- act: {keypoints: {right_hand: [0, 1]}}": r"keypoints: right_hand: expected 3 numbers, as in \[x, y, z\]",
    "- act: {keypoints: {right_hand: [0, 1, 2]}, hold: -1}": r"hold: expected 0 or more seconds, found '-1'",
    "- act: {keypoints: {right_hand: [0, 1, 2]}, name: ''}": r"name: expected a text, as in name: sit",
    "- act: {keypoints: {right_hand: [0, 1, 2]}, approach: here}": r"approach: expected 2 numbers",
    "- do: sit on the sofa": r"script\.yaml:2: step 1: 'do' needs cloud: FILE",
    "- do: ''": r"step 1 \(do\): expected a text, as in do: sit on the sofa",
    "- do: {hold: 2}": r"step 1 \(do\): 'text' is missing",
    "- wait: soon": r"step 1 \(wait\): expected a number \(seconds\), found 'soon'",
    "- wait:": r"step 1 \(wait\): expected a number \(seconds\), found nothing",
    "- stand: -2": r"step 1 \(stand\): expected 0 or more seconds",
}


@pytest.mark.parametrize("step", BAD)
def test_a_slip_in_a_step_is_told_with_its_number_and_line(step: str, folder: FilePath) -> None:
    with pytest.raises(ScriptError, match=BAD[step]) as caught:
        read(folder, f"steps:\n{step}\n")
    assert str(folder / "script.yaml") in str(caught.value)
    assert "\n" not in str(caught.value)


HEADS = {
    "": r"script\.yaml:1: 'steps' is missing",
    "steps: []": r"steps: give at least one step",
    "steps: walk": r"steps: expected a list of steps",
    "- wait: 1": r"expected scene, cloud, start, speed, seed, foot_lock or steps, found a list of 1",
    "seeed: 4\nsteps: [{wait: 1}]": r"script\.yaml:1: unknown key 'seeed'; did you mean seed\?",
    "steps: [{wait: 1}]\nseed: 1.5": r"script\.yaml:2: seed: expected a whole number from 0",
    "steps: [{wait: 1}]\nseed: -1": r"seed: expected a whole number from 0",
    "steps: [{wait: 1}]\nfoot_lock: 1": r"foot_lock: expected true or false, found '1'",
    "steps: [{wait: 1}]\nspeed: 40": r"script\.yaml:2: speed: speed must lie between 0\.3 and 5 m/s",
    "steps: [{wait: 1}]\nspeed: fast": r"speed: expected a number \(m/s\), found 'fast'",
    "steps: [{wait: 1}]\nstart: {heading: 3}": r"start: 'at' is missing",
    "steps: [{wait: 1}]\nstart: [1]": r"start: expected 2 numbers",
    "steps: [{wait: 1}]\ncloud: none.ply": r"cloud: there is no file",
    "steps: [{wait: 1}]\nscene: none.obj": r"scene: there is no file",
    "steps: [{wait: 1}]\nscene: {radius: 0.2}": r"scene: say either file: .* or floor:",
    "steps: [{wait: 1}]\nscene: {file: map.pgm, floor: []}": r"scene: say either file: .* or floor:",
    "steps: [{wait: 1}]\nscene: {file: map.pgm, obstacles: []}": r"obstacles belong to a floor",
    "steps: [{wait: 1}]\nscene: {file: map.pgm, resolution: 0}": r"resolution: expected a number above 0",
    "steps: [{wait: 1}]\nscene: {file: map.pgm, up: x}": r"up: expected y or z, found 'x'",
    "steps: [{wait: 1}]\nscene: {floor: [[[0, 0], [1, 1]]]}": r"floor 1: expected at least 3 corners",
    "steps: [{wait: 1}]\nscene: {floor: [[[0, 0], [1, 0], [1, 1]]], scale: 2}": r"scale: belongs to a file",
    "steps: [{wait: 1}]\nsteps: [{wait: 1}]": r"script\.yaml:2: 'steps' stands twice",
    "steps: [{wait: 1}": r"script\.yaml:\d+: is not YAML",
    "steps: &a [*a]": r"script\.yaml:1: an alias contains itself",
    "steps: [!!python/object:os.system {}]": r"script\.yaml:1: (is not YAML|step 1: expected one action)",
}


@pytest.mark.parametrize("text", HEADS)
def test_a_slip_above_the_steps_is_told_with_its_line(text: str, folder: FilePath) -> None:
    with pytest.raises(ScriptError, match=HEADS[text]):
        read(folder, text + "\n")


def test_a_script_that_is_no_text_or_not_there_is_told(folder: FilePath) -> None:
    with pytest.raises(ScriptError, match=r"gone\.yaml: there is no such file"):
        Script.read(folder / "gone.yaml")
    (folder / "latin.yaml").write_bytes("steps: [{do: 'grüß'}]".encode("latin-1"))
    with pytest.raises(ScriptError, match="is not UTF-8 text"):
        Script.read(folder / "latin.yaml")
    with pytest.raises(ScriptError, match="is a folder, not a file"):
        Script.read(folder)


def test_the_example_of_the_manual_is_a_script(folder: FilePath) -> None:
    manual = (FilePath(__file__).parents[3] / "docs" / "scripts.md").read_text(encoding="utf-8")
    example = manual.split("```yaml\n")[1].split("```")[0]
    script = read(folder, example)
    assert len(script.steps) > 5
    assert script.scene is not None
    script.scene.open()


def test_a_motion_of_a_text_is_a_step(tmp_path: FilePath) -> None:
    file = tmp_path / "wave.yaml"
    file.write_text("steps:\n  - do: {generate: wave, seconds: 2}\n  - do: {generate: bow}\n", encoding="utf-8")
    assert Script.read(file).steps == (Generate("wave", 2.0), Generate("bow", 3.0))
