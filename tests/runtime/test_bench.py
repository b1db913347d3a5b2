"""The benchmark: taking turns, percentiles, rivals, and the processes it starts. No test looks at a time."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from types import SimpleNamespace

import pytest
from fake_embedder import FakeEmbedder

from motionrt import runtime as runtime_module
from motionrt.bench import processes, report, rivals, worker
from motionrt.bench.first_answer import peak_mb
from motionrt.bench.roads import Setting, chosen
from motionrt.bench.timing import Timing, interleaved
from motionrt.bench.workload import ANSWER, MOTION, SEARCH_SIZES, TEXT, Workload, search_case
from motionrt.errors import InvalidInputError, MotionRTError

CASES = [TEXT, MOTION, *map(search_case, SEARCH_SIZES), ANSWER]
RETRIEVAL = ["text", "motion", "search", "retrieve", "cold"]


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard()


@pytest.fixture(autouse=True)
def fake_models(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runtime_module, "TextMotionModel", lambda *_, **__: FakeEmbedder())


def open_double(work: Workload, threads: int, models: str | None) -> rivals.Rival:
    """A rival that knows one case only."""
    return rivals.Rival({TEXT: lambda: (work.texts, threads, models)}, [sys.executable, "-c", "print('ready')"])


def test_contenders_take_turns_and_warm_up_before_every_turn() -> None:
    calls: list[str] = []
    timings = interleaved({"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}, rounds=2, calls=3)
    assert "".join(calls) == "aaaabbbbaaaabbbb"
    assert (timings["a"].runs, timings["b"].runs) == (6, 6)


def test_a_turn_that_takes_long_is_cut_short(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(range(100))
    monkeypatch.setattr(
        "motionrt.bench.timing.time", SimpleNamespace(perf_counter=lambda: next(clock), sleep=lambda _: None)
    )
    assert interleaved({"a": lambda: None}, rounds=2, calls=10)["a"].runs == 2


def test_percentiles_are_milliseconds() -> None:
    timing = Timing.of([i / 1000 for i in range(101)])
    assert (timing.p50_ms, timing.p95_ms, timing.runs) == (pytest.approx(50), pytest.approx(95), 101)


def test_times_are_those_of_one_unit() -> None:
    timing = Timing.of([0.064, 0.064], units=64)
    assert (timing.p50_ms, timing.p95_ms) == (pytest.approx(1.0), pytest.approx(1.0))


def test_every_case_does_what_its_name_says(work: Workload) -> None:
    setting = Setting(None, 1, work)
    found = [road.cases(setting) for road in chosen(RETRIEVAL).values()]
    cases = {name: case.call for part in found for name, case in part.items()}
    assert list(cases) == CASES
    assert cases[TEXT]().shape == cases[MOTION]().shape == (1, 256)
    for size in SEARCH_SIZES:
        found, _ = cases[search_case(size)]()
        expected = (-(work.vectors[:size] @ work.vectors[-1])).argsort()[:10]
        assert found.tolist() == expected.tolist()
    assert [hit.rank for hit in cases[ANSWER]()] == list(range(1, 11))


@dataclass
class Installed:
    """Stands for the installed entry points."""

    value: str

    def __call__(self, group: str, name: str | None = None) -> list[EntryPoint]:
        assert group == "motionrt.bench_rivals"
        return [EntryPoint("double", self.value, group)] if name in (None, "double") else []


def test_a_rival_is_measured_beside_the_cases_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed(f"{__name__}:open_double"))
    found = worker.measure(None, 1, "double", rounds=1, calls=2, only=RETRIEVAL)
    assert [case["case"] for case in found["cases"]] == CASES
    assert [case["case"] for case in found["cases"] if "against" in case] == [TEXT]
    text = found["cases"][0]
    assert text["against"]["ratio"] == pytest.approx(text["against"]["p50_ms"] / text["p50_ms"])
    assert found["rival_cold_start"][-1] == "print('ready')"


def test_a_rival_that_is_not_installed_is_named_with_those_that_are(
    monkeypatch: pytest.MonkeyPatch, work: Workload
) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed("anything:at_all"))
    with pytest.raises(InvalidInputError, match="cannot compare with 'torch': installed is double"):
        rivals.open_rival("torch", work, 1, None)


def test_a_rival_whose_packages_are_missing_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, work: Workload
) -> None:
    monkeypatch.setattr(rivals, "entry_points", Installed("no_such_package_anywhere:open"))
    with pytest.raises(InvalidInputError, match=r"no_such_package_anywhere.*pip install"):
        rivals.open_rival("double", work, 1, None)


def test_a_process_gets_its_number_of_threads() -> None:
    code = "import os; print(os.environ['OPENBLAS_NUM_THREADS'], os.environ['OMP_NUM_THREADS'])"
    _, lines = processes.first_line([sys.executable, "-c", code], threads=3)
    assert lines[0].split() == ["3", "3"]


def test_a_process_that_fails_is_an_error_with_its_last_line() -> None:
    code = "import sys; print('first', file=sys.stderr); sys.exit('the reason')"
    with pytest.raises(MotionRTError, match="the reason"):
        processes.first_line([sys.executable, "-c", code], threads=1)


def test_peak_memory_is_that_of_a_python_process() -> None:
    peak = peak_mb()
    if peak is None:
        pytest.skip("this system does not tell the peak memory of a process")
    assert 10 < peak < 100_000


def test_rows_have_a_column_for_every_header() -> None:
    case = {"case": TEXT, "p50_ms": 2.0, "p95_ms": 3.0, "runs": 4}
    other = {"name": "torch", "p50_ms": 10.0, "p95_ms": 12.0, "runs": 4, "ratio": 5.0}
    cold = {"seconds": 0.25, "runs": 2, "peak_mb_text": 100.4, "peak_mb_text_and_motion": None}
    run = {"threads": 1, "cases": [case, {**case, "against": other}], "left_out": {}, "cold_start": cold}
    assert report.rows(run) == [
        [TEXT, "2.00 ms", "3.00 ms", "500/s", "", ""],
        [TEXT, "2.00 ms", "3.00 ms", "500/s", "10.00 ms", "5.0 x"],
        ["cold start to first text", "250 ms", "", "", "", ""],
        ["peak memory, text", "100 MB", "", "", "", ""],
    ]


def test_the_machine_and_versions_are_told() -> None:
    assert report.machine()["cores"] >= 1
    assert report.versions()["python"] == ".".join(map(str, sys.version_info[:3]))
    assert "numpy" in report.versions()
