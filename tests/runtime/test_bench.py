"""The benchmark: taking turns, percentiles, rivals, and the processes it starts. No test looks at a time."""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass
from importlib.metadata import EntryPoint

import numpy as np
import pytest
from fake_embedder import FakeEmbedder

from motionrt.bench import processes, report, rivals, starts, timing, worker
from motionrt.bench.cases import BENCHMARKS, chosen
from motionrt.bench.files import LOAD, SAVE
from motionrt.bench.first_answer import peak_mb
from motionrt.bench.search import CLIPS, TEXT, answer_case, motion_case, search_case
from motionrt.bench.setting import Setting
from motionrt.bench.timing import Contest, Timing, Turns, timed
from motionrt.bench.workload import Workload
from motionrt.errors import InvalidInputError, MissingDependencyError, MotionRTError
from motionrt.services import search as search_module

SIZES = (500, 5_000)
RETRIEVAL = ["text", "motion", "search", "retrieve", "cold"]
CASES = [TEXT, *map(motion_case, CLIPS), *map(search_case, SIZES), *map(answer_case, SIZES)]


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard(SIZES)


@pytest.fixture(autouse=True)
def fake_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search_module, "TextMotionModel", lambda *_, **__: FakeEmbedder())


def open_double(work: Workload, threads: int, models: str | None) -> rivals.Rival:
    """A rival that knows one case only."""
    return rivals.Rival({TEXT: lambda: (work.texts, threads, models)}, [sys.executable, "-c", "print('ready')"])


def test_contenders_take_turns_after_warming_up_and_begin_in_turn() -> None:
    calls: list[str] = []
    contest = Contest({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")})
    found = timed({"case": contest}, Turns(rounds=3, calls=3, warm=2))["case"]
    assert "".join(calls) == "aaaaabbbbb" + "bbbbbaaaaa" + "aaaaabbbbb"
    assert (found["a"].runs, found["b"].runs) == (9, 9)


def test_strictly_in_turn_nobody_calls_twice() -> None:
    calls: list[str] = []
    contest = Contest({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")})
    found = timed({"case": contest}, Turns(rounds=2, calls=2, warm=2).strict())["case"]
    assert "".join(calls) == "abbaabba"
    assert found["a"].runs == 4


def test_cases_come_in_another_order_every_round_and_in_the_same_one_again() -> None:
    def order(seed: int) -> list[str]:
        calls: list[str] = []
        contests = {name: Contest({"a": lambda name=name: calls.append(name)}) for name in "uvwxyz"}
        timed(contests, Turns(rounds=4, calls=1, warm=0, seed=seed))
        return ["".join(calls[start : start + 6]) for start in range(0, 24, 6)]

    rounds = order(0)
    assert order(0) == rounds
    assert order(1) != rounds
    assert len(set(rounds)) > 1
    assert {"".join(sorted(each)) for each in rounds} == {"uvwxyz"}


def test_slow_cases_take_part_in_three_rounds_only() -> None:
    calls: Counter[str] = Counter()
    contests = {
        "fast": Contest({"a": lambda: calls.update(["fast"])}),
        "slow": Contest({"a": lambda: calls.update(["slow"])}, slow=True),
    }
    found = timed(contests, Turns(rounds=5, calls=4, warm=2))
    assert calls == {"fast": 5 * 6, "slow": 3 * 2}
    assert (found["fast"]["a"].runs, found["slow"]["a"].runs) == (20, 3)


def test_a_turn_that_takes_long_is_cut_short(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(range(100))
    monkeypatch.setattr(timing.time, "perf_counter", lambda: next(clock))
    assert timed({"case": Contest({"a": lambda: None})}, Turns(rounds=2, calls=10, warm=2))["case"]["a"].runs == 2


def test_the_median_is_over_turns_and_the_95th_percentile_over_calls() -> None:
    found = Timing.of([[0.001, 0.001, 0.009], [0.002, 0.002, 0.002], [0.005]])
    assert (found.p50_ms, found.runs) == (pytest.approx(2.0), 7)
    assert found.p95_ms == pytest.approx(np.percentile([1, 1, 9, 2, 2, 2, 5], 95))


def test_times_are_those_of_one_unit() -> None:
    found = Timing.of([[0.064, 0.064]], units=64)
    assert (found.p50_ms, found.p95_ms) == (pytest.approx(1.0), pytest.approx(1.0))


def test_every_case_does_what_its_name_says(work: Workload) -> None:
    setting = Setting(None, 1, work)
    parts = [benchmark.cases(setting) for benchmark in chosen(RETRIEVAL).values()]
    cases = {name: case for part in parts for name, case in part.items()}
    assert list(cases) == CASES
    assert cases[TEXT].call().shape == (1, 256)
    for clips in CLIPS:
        assert cases[motion_case(clips)].call().shape == (clips, 256)
        assert cases[motion_case(clips)].units == clips
    for size in SIZES:
        found, _ = cases[search_case(size)].call()
        expected = (-(work.vectors[:size] @ work.vectors[-1])).argsort()[:10]
        assert found.tolist() == expected.tolist()
        assert [hit.rank for hit in cases[answer_case(size)].call()] == list(range(1, 11))


def test_vectors_have_unit_length_and_are_the_same_every_time(work: Workload) -> None:
    np.testing.assert_allclose(np.linalg.norm(work.vectors, axis=1), 1.0, atol=1e-5)
    np.testing.assert_array_equal(Workload.standard(reversed(SIZES)).vectors, work.vectors)


def test_files_are_written_read_and_indexed_in_a_folder_that_is_removed(work: Workload) -> None:
    setting = Setting(None, 1, work)
    cases = BENCHMARKS["files"].cases(setting)
    load, save = cases[LOAD].call, cases[SAVE].call
    gallery = next(iter(BENCHMARKS["gallery"].cases(setting).values()))
    assert load().frames == 300
    assert save().is_file()
    assert len(gallery.call().gallery) == gallery.units == 8
    folder = setting.folder
    assert folder.is_dir()
    setting.close()
    assert not folder.exists()


@dataclass
class Installed:
    """Stands for the installed entry points."""

    value: str

    def __call__(self, group: str, name: str | None = None) -> list[EntryPoint]:
        assert group == "motionrt.bench_rivals"
        return [EntryPoint("double", self.value, group)] if name in (None, "double") else []


def test_a_rival_is_measured_beside_the_cases_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed(f"{__name__}:open_double"))
    turns = Turns(rounds=1, calls=2, warm=0)
    found = worker.measure(None, 1, ["double"], turns=turns, only=RETRIEVAL, sizes=SIZES, strict=True)
    assert [case["case"] for case in found["cases"]] == CASES
    assert [case["case"] for case in found["cases"] if case["against"]] == [TEXT]
    text = found["cases"][0]
    for row in (text, text["strict"]):
        assert row["against"]["double"]["ratio"] == pytest.approx(row["against"]["double"]["p50_ms"] / row["p50_ms"])
    assert found["rival_cold_starts"]["double"][-1] == "print('ready')"


def test_a_rival_that_is_not_installed_is_named_with_those_that_are(
    monkeypatch: pytest.MonkeyPatch, work: Workload
) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed("anything:at_all"))
    with pytest.raises(InvalidInputError, match="cannot compare with 'torch': installed is double"):
        rivals.open_rival("torch", work, 1, None)


@pytest.mark.parametrize(
    ("module", "remedy"), [("no_such_package", "pip install motionrt-export"), ("double", "pip install double")]
)
def test_a_rival_whose_packages_are_missing_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, work: Workload, module: str, remedy: str
) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed(f"{module}:open"))
    with pytest.raises(MissingDependencyError, match=f"No module named '{module}'; try: {remedy}"):
        rivals.open_rival("double", work, 1, None)


def test_benchmarks_on_request_are_gone_only_when_they_are_named() -> None:
    assert "approximate" not in chosen(None)
    assert list(chosen(["approximate"])) == ["approximate"]


def test_a_process_gets_its_number_of_threads() -> None:
    code = "import os; print(os.environ['OPENBLAS_NUM_THREADS'], os.environ['OMP_NUM_THREADS'])"
    _, lines = processes.first_line([sys.executable, "-c", code], threads=3)
    assert lines[0].split() == ["3", "3"]


def test_a_process_that_fails_is_an_error_with_its_last_line() -> None:
    code = "import sys; print('first', file=sys.stderr); sys.exit('the reason')"
    for start in (processes.first_line, processes.whole):
        with pytest.raises(MotionRTError, match="the reason"):
            start([sys.executable, "-c", code], threads=1)


def test_cold_starts_tell_what_every_process_says_of_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def first_line(command: list[str], threads: int) -> tuple[float, list[str]]:
        asked.append(command[-1])
        if command[-1] == "rival":
            return 6.0, ['{"peak_mb": 460.0}\n']
        return float(len(asked)), ['{"import_s": 0.1, "peak_mb": 140.0}\n', "some other line"]

    monkeypatch.setattr(starts, "first_line", first_line)
    monkeypatch.setattr(starts, "whole", lambda command, threads: 0.05)
    found = starts.cold_starts("models", 1, 3, {"other": ["rival"]})
    assert asked[1::2] == ["rival"] * 3
    assert (found["seconds"], found["import_s"], found["python_s"], found["retrieve_s"]) == (3.0, 0.1, 0.05, None)
    assert found["against"] == {"other": {"seconds": 6.0, "ratio": 2.0, "peak_mb": 460.0}}
    assert found["peak_mb"] == 140.0


def test_peak_memory_is_that_of_a_python_process() -> None:
    peak = peak_mb()
    if peak is None:
        pytest.skip("this system does not tell the peak memory of a process")
    assert 10 < peak < 100_000


def test_the_machine_and_versions_are_told() -> None:
    assert report.machine()["cores"] >= 1
    assert report.versions()["python"] == ".".join(map(str, sys.version_info[:3]))
    assert "numpy" in report.versions()
