"""The verbs that move a character: what each takes and gives; and the same on the models that ship."""

from __future__ import annotations

import subprocess
import sys
from itertools import islice
from pathlib import Path as FilePath

import numpy as np
import pytest
from fake_character_models import FPS, FakeCharacterModels, turns_gently
from motions import random_motion, walking

from motionrt import Act, Follow, Goal, Path, Runtime, Scene, WalkTo, load_motion
from motionrt.errors import FormatError, InvalidInputError, ModelFileError, MotionFileNotFoundError, PathError
from motionrt.locomotion.bearings import facing_of
from motionrt.locomotion.starting_poses import stride_of
from motionrt.models import find_manifest, load_manifest

ROOM = Scene.from_polygons([[[-3, -1], [3, -1], [3, 9], [-3, 9]]], [[[-1.5, 3], [1, 3], [1, 5], [-1.5, 5]]])


@pytest.fixture
def runtime() -> Runtime:
    made = Runtime()
    made.character_models = FakeCharacterModels()  # type: ignore[misc]  # fills the cached property
    return made


def test_a_walk_stands_at_both_ends_and_measures_itself(runtime: Runtime) -> None:
    walk = runtime.walk((3, 8), foot_lock=False)
    np.testing.assert_allclose(walk.motion.root[[0, -1]][:, [0, 2]], [[0, 0], [3, 8]], atol=1e-3)
    np.testing.assert_allclose(
        walk.motion.rotations[-1, 1:], FakeCharacterModels().standing.rotations[0, 1:], atol=1e-5
    )
    assert walk.measures.goal_distance_m == pytest.approx(0, abs=1e-3)
    assert walk.measures.waypoints_reached == 1.0
    assert walk.measures.path_deviation_m == pytest.approx(0, abs=5e-3)  # the weight goes from foot to foot
    assert walk.path.length == pytest.approx(np.hypot(3, 8), abs=1e-4)
    assert len(walk.waypoints) == 9


def test_a_walk_without_a_start_heading_begins_along_its_path(runtime: Runtime) -> None:
    walk = runtime.walk((5, 0), start=(1, 0))
    assert facing_of(walk.motion[:1]) == pytest.approx(np.pi / 2, abs=1e-3)
    turned = runtime.walk((5, 0), start=(1, 0, 0.0), heading=0.5)
    assert facing_of(turned.motion[:1]) == pytest.approx(0, abs=1e-3)
    assert facing_of(turned.motion) == pytest.approx(0.5, abs=1e-3)


def test_a_path_may_be_a_path_points_or_a_file(runtime: Runtime, tmp_path: FilePath) -> None:
    points = np.array([[2, 1], [2, 5], [4, 5]], np.float32)
    file = tmp_path / "way.csv"
    file.write_text("x;z\n2;1\n2;5\n4;5\n", encoding="utf-8")
    first, *others = (runtime.walk(path=path) for path in (Path(points), points, points.tolist(), file, str(file)))
    np.testing.assert_allclose(first.motion.root[0, [0, 2]], [2, 1], atol=1e-3)
    for other in others:
        np.testing.assert_array_equal(other.motion.root, first.motion.root)


def test_a_walk_goes_round_what_stands_in_the_scene(runtime: Runtime) -> None:
    walk = runtime.walk((0, 8), scene=ROOM)
    assert ROOM.grid.is_walkable(walk.motion.root[:, [0, 2]]).all()
    assert walk.path.length > 8.1
    np.testing.assert_array_equal(runtime.plan(ROOM, (0, 0), (0, 8)).points, walk.path.points)


def test_a_scene_may_be_a_file(runtime: Runtime, tmp_path: FilePath) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 120 120 255\n" + bytes([254]) * 120 * 120)
    (tmp_path / "map.yaml").write_text(
        "{image: map.pgm, resolution: 0.1, origin: [0, 0, 0], negate: 0, occupied_thresh: 0.65, free_thresh: 0.2}",
        encoding="utf-8",
    )
    path = runtime.plan(tmp_path / "map.yaml", (2, -2), (9, -9))
    assert path.length == pytest.approx(7 * np.sqrt(2), abs=0.1)
    with pytest.raises(PathError, match="outside the scene"):
        runtime.plan(str(tmp_path / "map.yaml"), (2, -2), (9, 9))


def test_a_walk_goes_on_from_a_motion_and_ends_in_stride_if_asked(runtime: Runtime) -> None:
    before = stride_of(walking(60, FPS))
    walk = runtime.walk((0, 6), start=before, stop=False, foot_lock=False)
    np.testing.assert_allclose(walk.motion.root[0, [0, 2]], [0, 1.2 / FPS], atol=1e-4)
    assert walk.motion.frames == pytest.approx(6 / 1.2 * FPS, abs=4)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "either to="),
        ({"to": (1, 2), "path": [[0, 0], [1, 1]]}, "either to="),
        ({"to": (1, 2, 3)}, "where to walk to is x and z"),
        ({"to": ("a", "b")}, "where to walk to is x and z"),
        ({"to": (0, 0)}, "already: nothing to walk"),
        ({"to": (4, 4), "start": (1,)}, "a start is"),
        ({"to": (4, 4), "start": (np.nan, 0)}, "a start is"),
        ({"to": (4, 4), "speed": 30}, "speed must lie"),
        ({"to": (4, 4), "scene": 7}, "a scene is a Scene"),
        ({"to": (4, 4), "start": random_motion(30, 20.0)}, "resample"),
        ({"path": [[0, 0, 0], [1, 1, 1]]}, "shape"),
    ],
)
def test_a_walk_that_makes_no_sense_is_refused(runtime: Runtime, options: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        runtime.walk(**options)  # type: ignore[arg-type]


def test_files_that_are_missing_or_broken_are_told(runtime: Runtime, tmp_path: FilePath) -> None:
    with pytest.raises(MotionFileNotFoundError):
        runtime.walk((4, 4), scene=tmp_path / "none.obj")
    (tmp_path / "way.csv").write_text("1,2\n3,x\n", encoding="utf-8")
    with pytest.raises(FormatError, match=r"way\.csv:2"):
        runtime.walk(path=tmp_path / "way.csv")


def test_walks_together_are_those_of_each_alone(runtime: Runtime) -> None:
    ways = [[[0, 0], [0, 6]], [[3, 0], [3, 4], [6, 4]]]
    together = runtime.walk_together(ways, foot_lock=False)
    for way, walk in zip(ways, together, strict=True):
        alone = runtime.walk(path=way, foot_lock=False)
        assert walk.motion.frames == alone.motion.frames
        np.testing.assert_allclose(walk.motion.root, alone.motion.root, atol=1e-4)
    with pytest.raises(InvalidInputError, match="a start for each"):
        runtime.walk_together(ways, starts=[None])
    with pytest.raises(InvalidInputError, match="at least one path"):
        runtime.walk_together([])


def test_a_stream_takes_a_new_goal_between_frames(runtime: Runtime) -> None:
    runtime.character_models = FakeCharacterModels(turns_gently)  # type: ignore[misc]
    walker = runtime.stream((0, 20), start=stride_of(walking(60, FPS)))
    seen = [next(walker) for _ in range(30)]
    assert {frame.frames for frame in seen} == {1}
    after = [walker.send(Goal(20, 0)), *islice(walker, 60)]
    assert after[-1].root[0, 0] > 1.5 > abs(seen[-1].root[0, 0])


def test_a_crowd_steps_together(runtime: Runtime) -> None:
    crowd = runtime.crowd(8)
    before = crowd.positions
    frames = crowd.step(np.tile([0.0, 50.0, 0.0], (8, 1)), 1.5)
    assert frames.shape == (8, 219)
    np.testing.assert_allclose(np.linalg.norm(crowd.positions - before, axis=1), 1.5 / FPS, atol=1e-5)
    assert len(runtime.crowd([(0, 0, 1), Goal(1, 1)])) == 2


def test_a_pose_and_a_transition_into_it(runtime: Runtime) -> None:
    pose = runtime.pose({"right_hand": (0.3, 1.3, 2.0)}, heading=0.0).motion
    between = runtime.transition(runtime.walk((0, 1.5)).motion, pose, held=True)
    assert between.frames == 60
    np.testing.assert_allclose(between.root[-1], pose.root[0], atol=1e-5)


def test_a_performance_is_saved_and_measured(runtime: Runtime, tmp_path: FilePath) -> None:
    grab = Act({"right_hand": (2.0, 1.2, 4.0)}, heading=0.0, name="grab")
    done = runtime.perform(ROOM, [WalkTo(0, 2), grab, Follow(Path(np.array([[2, 4], [2, 8]])))], seed=3)
    again = runtime.perform(ROOM, [WalkTo(0, 2), grab, Follow(Path(np.array([[2, 4], [2, 8]])))], seed=3)
    np.testing.assert_array_equal(done.motion.rotations, again.motion.rotations)
    figures = done.measures.as_dict()
    assert figures["keypoint_max_cm"] == pytest.approx(0, abs=5)
    assert figures["frames"] == done.motion.frames
    loaded = load_motion(done.save(tmp_path / "done.bvh"))
    np.testing.assert_allclose(loaded.positions(), done.motion.positions(), atol=2e-3)


def test_a_script_is_played(runtime: Runtime, tmp_path: FilePath) -> None:
    file = tmp_path / "s.yaml"
    file.write_text(
        "{start: {at: [1, 0], heading: 90}, foot_lock: false, steps: [walk: {to: [6, 0]}]}", encoding="utf-8"
    )
    done = runtime.play(file)
    np.testing.assert_allclose(done.motion.root[-1, [0, 2]], [6, 0], atol=1e-3)
    assert facing_of(done.motion[:1]) == pytest.approx(np.pi / 2, abs=1e-3)


LIGHT = """
import sys
sys.path[:0] = {paths!r}
import motionrt
print(sorted(name for name in sys.modules if name.split(".")[0] in ("numpy", "scipy", "onnxruntime", "yaml")))
from motionrt.runtime import Runtime
print([name for name in sys.modules if name.startswith("motionrt.locomotion.scene")])
from motionrt.locomotion import starting_poses, character_models, walk, streaming, crowd_start, performing, script
print([name for name in sys.modules if name.split(".")[0] in ("scipy", "onnxruntime", "yaml", "trimesh", "PIL")])
"""


def test_importing_is_light_and_walking_needs_no_scipy() -> None:
    done = subprocess.run(
        [sys.executable, "-c", LIGHT.format(paths=sys.path)],
        capture_output=True,
        text=True,
        check=True,
        encoding="utf-8",
    )
    assert done.stdout.split() == ["[]"] * 3


# -- on the models that ship


@pytest.fixture(scope="module")
def shipped() -> Runtime:
    try:
        models = load_manifest(find_manifest()).models
    except ModelFileError as error:
        pytest.skip(f"no models here: {error}")
    missing = {"walknet", "transnet", "pose_prior"} - models.keys()
    if missing:
        pytest.skip(f"the manifest has no {', '.join(sorted(missing))} yet")
    return Runtime(threads=1)


def test_shipped_models_walk_to_a_place(shipped: Runtime) -> None:
    walk = shipped.walk((4, 9))
    assert walk.measures.goal_distance_m is not None
    assert walk.measures.goal_distance_m < 0.2
    assert walk.measures.path_deviation_m is not None
    assert walk.measures.path_deviation_m < 0.35
    assert walk.measures.waypoints_reached == 1.0
    steps = np.linalg.norm(np.diff(walk.motion.root, axis=0), axis=1)
    assert steps.max() < 0.1


def test_shipped_models_walk_together(shipped: Runtime) -> None:
    walks = shipped.walk_together([[[0, 0], [0, 6]], [[3, 0], [3, 4], [6, 4]]])
    assert all(walk.measures.goal_distance_m is not None and walk.measures.goal_distance_m < 0.2 for walk in walks)


def test_shipped_models_stream(shipped: Runtime) -> None:
    walker = shipped.stream((0, 6))
    frames = list(islice(walker, 330))
    assert np.linalg.norm(frames[-1].root[0, [0, 2]] - [0, 6]) < 0.3
    walker.send(Goal(4, 6, 1.6))
    assert np.linalg.norm(list(islice(walker, 330))[-1].root[0, [0, 2]] - [4, 6]) < 0.3


def test_shipped_models_move_a_crowd(shipped: Runtime) -> None:
    crowd = shipped.crowd(4)
    goals = crowd.positions + np.array([0.0, 30])
    before = crowd.positions
    for _ in range(60):
        crowd.step(np.column_stack([goals, np.zeros(4)]))
    np.testing.assert_allclose(crowd.positions - before, np.tile([0, 2.4], (4, 1)), atol=0.5)


def test_shipped_models_meet_keypoints_and_get_there(shipped: Runtime) -> None:
    found = shipped.pose({"right_hand": (0.3, 1.2, 0.5), "left_foot": (0.1, 0, 0.1), "right_foot": (-0.1, 0, 0.1)})
    assert found.mean_error_cm < 2
    between = shipped.transition(shipped.character_models.standing, found.motion, held=True)
    np.testing.assert_allclose(between.positions()[-1], found.motion.positions()[0], atol=0.02)


def test_shipped_models_perform(shipped: Runtime) -> None:
    grab = {"right_hand": (0.3, 1.2, 5.4), "left_foot": (0.1, 0, 5.0), "right_foot": (-0.1, 0, 5.0)}
    low = grab | {"right_hand": (0.3, 0.6, 5.4)}
    done = shipped.perform(ROOM, [Act(grab, 0.0), Act(low, 0.0), WalkTo(0, 1)], start=(2.5, 0))
    assert done.measures.keypoint_cm is not None
    assert done.measures.keypoint_cm < 3
    assert done.measures.largest_step_cm < 10
