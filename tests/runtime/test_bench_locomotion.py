"""The benchmark of walking and acting: its inputs, what it calls, what it leaves out, and what follows from times."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels, towards_goal
from tiny_models import edited

from motionrt.bench import cases, report, tables, worker
from motionrt.bench.cases import BENCHMARKS, Benchmark, chosen
from motionrt.bench.locomotion import (
    CROWDS,
    PERFORM,
    POSE,
    TRANSITION,
    Moves,
    pose_call,
    transition_call,
    walk_call,
    walk_case,
)
from motionrt.bench.setting import Setting
from motionrt.bench.timing import Turns
from motionrt.bench.workload import Workload
from motionrt.cli import main
from motionrt.errors import InvalidInputError, WalkError
from motionrt.models.pose_prior import PosePrior

ONCE = Turns(rounds=1, calls=1, warm=0)


@pytest.fixture(scope="module")
def moves() -> Moves:
    return Moves.standard()


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard()


def fill(frames: np.ndarray, hidden: np.ndarray) -> np.ndarray:
    """The target pose in all hidden frames."""
    return np.where(hidden[..., None], frames[:, -1:], frames)


def stiff(latents: np.ndarray) -> np.ndarray:
    return np.tile(np.eye(3, dtype=np.float32), (len(latents), 24, 1, 1))


class Doubles(FakeCharacterModels):
    """Stand-ins for all models, as the benchmark asks for them."""

    def __init__(self) -> None:
        super().__init__()
        self.infill, self.prior = fill, PosePrior(stiff)


def double_setting(work: Workload, threads: int) -> Setting:
    setting = Setting(None, threads, work)
    setting.runtime.character_models = Doubles()
    return setting


def test_walkers_are_people_whose_goals_are_a_metre_ahead(moves: Moves) -> None:
    rotations = moves.histories[..., :216].reshape(-1, 3, 3)
    assert moves.histories.shape == (64, 30, 219)
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0, atol=1e-5)
    ahead = moves.goals[:, :2] - moves.histories[:, -1, [216, 218]]
    np.testing.assert_allclose(ahead, np.tile([0.0, 1.0], (64, 1)), atol=1e-6)
    assert np.diff(np.sort(moves.histories[:, -1, 216])).min() > 1.0


@pytest.mark.parametrize("count", CROWDS)
def test_a_walk_is_the_same_step_of_all_every_time(moves: Moves, count: int) -> None:
    step = walk_call(towards_goal, moves, count)
    first, second = np.asarray(step()), np.asarray(step())
    np.testing.assert_array_equal(first, second)
    covered = first[:, [216, 218]] - moves.histories[:count, -1, [216, 218]]
    np.testing.assert_allclose(covered, np.tile([0.0, 1.2 / 30], (count, 1)), atol=1e-6)


def test_a_transition_ends_in_its_target_where_it_shall_stand(moves: Moves) -> None:
    found = transition_call(fill, moves)()
    assert found.frames == 60
    np.testing.assert_allclose(found.root[-1, [0, 2]], [moves.place.x, moves.place.z], atol=1e-3)


def test_every_pose_is_solved_even_where_it_is_out_of_reach(moves: Moves) -> None:
    solve = pose_call(PosePrior(stiff), moves)
    found = [solve() for _ in moves.poses]
    assert [set(solution.errors_cm) for solution in found] == [set(keypoints) for keypoints in moves.poses]


def test_every_benchmark_has_its_cases(work: Workload) -> None:
    setting = double_setting(work, threads=1)
    assert list(BENCHMARKS["walk"].cases(setting))[:2] == ["walk, 1 character", "walk, 2 characters"]
    assert [case.units for case in BENCHMARKS["walk"].cases(setting).values()] == list(CROWDS)
    assert list(BENCHMARKS["transition"].cases(setting)) == [TRANSITION]
    assert list(BENCHMARKS["pose"].cases(setting)) == [POSE]


def test_the_performance_is_timed_by_the_frame(work: Workload) -> None:
    case = BENCHMARKS["perform"].cases(double_setting(work, threads=1))[PERFORM]
    assert case.slow
    assert case.units == case.call() > 300


def test_benchmarks_without_models_are_left_out(tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda content: [content["models"].pop(name, None) for name in ("walknet", "transnet")])
    found = worker.measure(str(manifest), 1, turns=ONCE, only=["walk", "transition", "search"], sizes=(100, 200))
    assert found["left_out"] == {"walk": "no model walknet", "transition": "no model transnet"}
    assert len(found["cases"]) == 2


def test_a_benchmark_that_the_models_cannot_walk_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def stuck(_: Setting) -> dict[str, cases.Case]:
        raise WalkError("the character stays where it is")

    monkeypatch.setattr(cases, "BENCHMARKS", {"perform": Benchmark((), stuck)})
    found = worker.measure(None, 1, turns=ONCE)
    assert found["left_out"] == {"perform": "the character stays where it is"}
    assert found["cases"] == []


def test_an_unknown_benchmark_is_refused_with_those_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InvalidInputError, match=r"no benchmark is called swim; choose from: text, full-text, motion"):
        chosen(["walk", "swim"])
    assert main(["bench", "--only", "swim"]) == 1
    assert "no benchmark is called swim" in capsys.readouterr().err


def test_how_many_characters_two_cores_animate() -> None:
    cases = [
        {"case": walk_case(1), "p50_ms": 2.5, "against": {"torch": {"p50_ms": 12.5}}},
        {"case": walk_case(64, spread=True), "p50_ms": 1.0, "against": {"torch": {"p50_ms": 8.0}}},
    ]
    found = report.derived(cases)
    assert found["characters_at_30_fps"] == {
        "count": 33,
        "case": "walk, 64 characters, spread",
        "against": {"torch": {"count": 4, "ratio": pytest.approx(8.0)}},
    }


def test_a_performance_is_told_in_times_of_real_time() -> None:
    assert report.derived([{"case": PERFORM, "p50_ms": 4.0}])["perform_times_real_time"] == pytest.approx(
        8.3333, abs=1e-3
    )


def test_rows_show_what_follows_and_leave_out_what_was_not_measured() -> None:
    case = {"case": walk_case(8), "p50_ms": 2.0, "p95_ms": 3.0, "against": {}}
    run = {"threads": 1, "cases": [case], "left_out": {}, **report.derived([case])}
    assert tables.rows({**run, "perform_times_real_time": 7.26}, ["torch"]) == [
        ["walk, 8 characters", "2.00 ms", "3.00 ms", "500/s", "", ""],
        ["characters at 30 fps (walk, 8 characters)", "16", "", "", "", ""],
        ["perform, times real time", "7.3 x", "", "", "", ""],
    ]
