"""Where a benchmark's time goes: its models and their operators by onnxruntime's profiler, its Python by cProfile."""

from __future__ import annotations

import cProfile
import pstats
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionrt.bench.answering import answered
from motionrt.bench.cases import COLD, chosen
from motionrt.bench.nodes import Work, read_work
from motionrt.bench.setting import Setting
from motionrt.bench.timing import Call, Case
from motionrt.bench.workload import Workload
from motionrt.errors import InvalidInputError
from motionrt.models.sessions import quiet_options

SIZES = (10_000,)
MOST_CALLS, LISTED = 50, 12


@dataclass(frozen=True)
class BenchmarkWork:
    """What one call of a benchmark's first case does in its models.

    Attributes:
        case: its name.
        units: characters, clips or frames of one call.
        wall_s: of a call, with the profiler running.
        models: the work by model.
    """

    case: str
    units: int
    wall_s: float
    models: dict[str, Work]

    @property
    def all(self) -> Work:
        """The work of all models."""
        return sum(self.models.values(), Work())


def benchmark_work(
    benchmark: str, models: str | None, threads: int, variant: str | None = None, seconds: float = 1.0
) -> BenchmarkWork:
    """Run a benchmark for so many seconds, or 50 times, with onnxruntime's profiler on.

    Raises:
        InvalidInputError: no benchmark of that name, or one without a case that can be called.
    """
    needed = chosen([benchmark])[benchmark].models
    with tempfile.TemporaryDirectory(prefix="motionrt-profile-") as folder:
        options = quiet_options(threads)
        options.enable_profiling = True
        setting = Setting(models, threads, Workload.standard(SIZES), variant=variant, session_options=options)
        with closing(setting):
            _check(setting, benchmark)
            names = setting.named(needed)
            sessions: dict[str, Any] = {}
            for name in names:  # one after the other, each into a file of its own name
                options.profile_file_prefix = str(Path(folder) / name)
                sessions[name] = setting.sessions(name).session(name, variant)
            label, case = _first(setting, benchmark)
            calls, wall = _repeat(case.call, seconds)
            profiles = {name: Path(session.end_profiling()) for name, session in sessions.items()}
            found = {name: read_work(path).of_one(calls) for name, path in profiles.items()}
    return BenchmarkWork(label, case.units, wall / calls, found)


def python_work(benchmark: str, models: str | None, threads: int, variant: str | None = None) -> list[dict[str, Any]]:
    """The functions that take most of a call of a benchmark, by their own time: ``function``, and ``calls`` and ``ms``
    of one call.
    """
    with closing(Setting(models, threads, Workload.standard(SIZES), variant=variant)) as setting:
        _check(setting, benchmark)
        call = _first(setting, benchmark)[1].call
        call()
        profiler = cProfile.Profile()
        profiler.enable()
        calls, _ = _repeat(call)
        profiler.disable()
    statistics: dict[tuple[str, int, str], tuple[Any, ...]] = pstats.Stats(profiler).stats  # type: ignore[attr-defined]
    longest = sorted(statistics.items(), key=lambda item: -item[1][2])[:LISTED]
    return [
        {"function": _name(*where), "calls": found[1] / calls, "ms": 1000 * found[2] / calls}
        for where, found in longest
    ]


def _check(setting: Setting, benchmark: str) -> None:
    if missing := setting.missing(chosen([benchmark])[benchmark].models):
        raise InvalidInputError(f"the benchmark {benchmark} needs models that are not there: {', '.join(missing)}")
    if benchmark in (COLD, "models"):
        raise InvalidInputError(f"the benchmark {benchmark} cannot be profiled: it is many things; choose another one")


def _first(setting: Setting, benchmark: str) -> tuple[str, Case]:
    """The first case of a benchmark."""
    return next(iter(chosen([benchmark])[benchmark].cases(setting).items()))


def _repeat(call: Call, most_s: float = 1.0) -> tuple[int, float]:
    """How often a call was made, and the seconds of all."""
    started, calls = time.perf_counter(), 0
    while not calls or (calls < MOST_CALLS and time.perf_counter() - started < most_s):
        call()
        calls += 1
    return calls, time.perf_counter() - started


def _name(file: str, line: int, function: str) -> str:
    """``module.py:line function``, without the folders in front."""
    path = Path(file)
    return function if file == "~" else f"{'/'.join(path.parts[-2:])}:{line} {function}"


def profile(benchmark: str, models: str | None, threads: int, variant: str | None = None) -> dict[str, Any]:
    """Everything that ``motionrt bench --profile`` prints, times in ms of one call."""
    work = benchmark_work(benchmark, models, threads, variant)
    in_models = work.all.run_seconds
    return {
        "benchmark": benchmark,
        "case": work.case,
        "units": work.units,
        "threads": threads,
        "wall_ms": 1000 * work.wall_s,
        "models_ms": {name: 1000 * each.run_seconds for name, each in work.models.items()},
        "outside_ms": 1000 * (work.wall_s - in_models),
        "operators_ms": _longest(work.all.seconds),
        "python": python_work(benchmark, models, threads, variant),
    }


def _longest(seconds: Mapping[str, float]) -> dict[str, float]:
    """Milliseconds of the operators that take longest."""
    first = sorted(seconds.items(), key=lambda item: -item[1])[:LISTED]
    return {name: 1000 * value for name, value in first}


def main(arguments: Sequence[str] = tuple(sys.argv[1:])) -> int:
    """The profile for the arguments of the command line."""
    return answered(profile, arguments)


if __name__ == "__main__":
    sys.exit(main())
