"""The measures and tables of ``benchmarks/walks.py``, and the scene and script of ``examples/``."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from motions import walking

from motionrt import Motion, Script
from motionrt.locomotion.words import action_keypoints, load_cloud

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def walks() -> Iterator[SimpleNamespace]:
    """The modules of ``benchmarks/`` as one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks")
        found = [import_module(name) for name in ("walk_rows", "walk_tables", "walks")]
        yield SimpleNamespace(**{name: value for module in found for name, value in vars(module).items()})


@pytest.fixture(scope="module")
def walk() -> Motion:
    """Eighty seconds straight along +Z."""
    motion = walking(2400, 30.0)
    root = motion.root.copy()
    root[:, 0], root[:, 2] = 0.0, np.linspace(0, 96, 2400)
    return replace(motion, root=root)


def test_a_walk_beside_its_path_is_measured(walks: SimpleNamespace, walk: Motion) -> None:
    path = np.array([[0.1, 0.0], [0.1, 96.0]])
    row = walks.row_of("aside", walk, path, path[1:], 0.4, 8.0)
    assert (row.length_m, row.seconds, row.waypoints) == (pytest.approx(96.0), pytest.approx(80.0), 1.0)
    assert (row.off_path_m, row.goal_m) == (pytest.approx(0.1, abs=1e-3), pytest.approx(0.1, abs=1e-3))
    assert row.first.off_path_m == pytest.approx(row.last.off_path_m, abs=1e-3)
    assert row.times_real_time == 8.0


def test_a_walk_that_drifts_away_is_told_by_its_last_half_minute(walks: SimpleNamespace, walk: Motion) -> None:
    root = walk.root.copy()
    root[:, 0] = np.linspace(0.0, 0.6, len(root))
    path = np.array([[0.0, 0.0], [0.0, 96.0]])
    row = walks.row_of("drifts", replace(walk, root=root), path, path[1:], 0.4)
    assert (row.first.off_path_m, row.last.off_path_m) == (
        pytest.approx(0.1125, abs=0.01),
        pytest.approx(0.4875, abs=0.01),
    )
    faults = " ".join(walks.broken(row))
    assert "last 30 s, distance from the path" in faults
    assert "distance from the goal, m: 0.600, but the limit is 0.200" in faults


def good(walks: SimpleNamespace) -> object:
    spell = walks.Spell(0.1, 0.5, 0.93)
    return walks.Row("hall", 150.0, 130.0, 1.0, 0.1, 0.4, 0.05, 0.5, 0.9, 200.0, 0.93, 0.4, spell, spell, 7.0)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"waypoints": 0.99}, "waypoints"),
        ({"off_path_m": 0.351}, "from the path"),
        ({"goal_m": 0.21}, "from the goal"),
        ({"skate_cm": 0.93}, "skate"),
        ({"height_drift_cm": -3.1}, "height"),
        ({"off_path_m": float("nan")}, "from the path"),
    ],
)
def test_each_limit_is_checked(walks: SimpleNamespace, change: dict[str, float], fault: str) -> None:
    assert walks.broken(good(walks)) == []
    found = walks.broken(replace(good(walks), **change))  # type: ignore[type-var]
    assert len(found) == 1
    assert fault in found[0]


def test_feet_may_not_slide_much_more_than_recorded_ones(walks: SimpleNamespace) -> None:
    mocap = walks.Recorded(trials=10, seconds=60.0, skate_cm=0.7, skate_locked_cm=0.4, jerk=150.0, height_m=0.92)
    assert walks.broken(good(walks), mocap) == []
    found = walks.broken(good(walks), replace(mocap, skate_locked_cm=0.38))
    assert found == ["foot skate against recorded walks, locked feet, cm/frame: 0.500, but the limit is 0.494"]
    found = walks.broken(good(walks), replace(mocap, skate_cm=0.69))
    assert found == ["foot skate against recorded walks, unlocked feet, cm/frame: 0.900, but the limit is 0.897"]


def test_all_walks_together_are_weighted_with_time(walks: SimpleNamespace) -> None:
    row = good(walks)
    other = replace(row, scene="yard", seconds=390.0, off_path_m=0.3, goal_m=0.15, height_drift_cm=-2.0)  # type: ignore[type-var]
    both = walks.together([row, other])
    assert (both.length_m, both.seconds, both.off_path_m) == (300.0, 520.0, pytest.approx(0.25))
    assert (both.goal_m, both.height_drift_cm) == (0.15, -2.0)
    lines = walks.table([row, other]).splitlines()
    assert [line.split(" | ")[0] for line in lines[2:]] == ["| hall", "| yard", "| all"]
    assert len({line.count("|") for line in [*lines, lines[1]]}) == 1
    assert len({line.count("|") for line in walks.drift_table([row, other]).splitlines()}) == 1


def test_recorded_walks_are_measured_at_30_fps(walks: SimpleNamespace) -> None:
    found = walks.recorded([walking(120, 60.0), walking(240, 60.0)])
    assert (found.trials, found.seconds) == (2, pytest.approx(6.0, abs=0.1))
    assert found.skate_cm > 0


def test_plain_walks_are_those_that_are_described_so(walks: SimpleNamespace, tmp_path: Path) -> None:
    (tmp_path / "bvh").mkdir()
    walking(60, 60.0).save(tmp_path / "bvh" / "02_01.bvh")
    rows = ["trial,format,description", "02_01,bvh,walk", "02_03,bvh,run", "05_01,bvh,slow walk"]
    (tmp_path / "index.csv").write_text("\n".join(rows), encoding="utf-8")
    assert [motion.frames for motion in walks.plain_walks(tmp_path)] == [60]


def test_the_living_room_can_be_walked_and_its_words_are_understood() -> None:
    script = Script.read(ROOT / "examples" / "living_room.yaml")
    assert script.scene is not None
    assert script.cloud is not None
    scene, cloud, place = script.scene.open(), load_cloud(script.cloud), (script.start.x, script.start.z)
    lengths = []
    for step in script.steps:
        text = getattr(step, "text", None)
        goal = action_keypoints(text, cloud, place).approach if text else getattr(step, "x", None) and (step.x, step.z)
        if goal is not None:
            lengths.append(scene.plan(place, goal).length)
            place = (float(goal[0]), float(goal[1]))
    assert lengths[0] > 10.0
    assert lengths[2] < 0.5  # the second grab is where the first one was


def test_the_living_rooms_points_are_those_that_its_program_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = importlib.util.spec_from_file_location("make_living_room", ROOT / "examples" / "make_living_room.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(sys, "argv", ["make_living_room.py", str(tmp_path / "room.csv")])
    module.main()
    assert (tmp_path / "room.csv").read_bytes() == (ROOT / "examples" / "living_room.csv").read_bytes()
