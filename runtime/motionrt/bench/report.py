"""A whole benchmark: the machine, every thread count, cold starts, memory, limits; as data."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from importlib import metadata
from pathlib import Path
from typing import Any

from motionrt.bench.cases import COLD, chosen
from motionrt.bench.footprint import install_sizes
from motionrt.bench.graphs import graph_case
from motionrt.bench.limits import against_times
from motionrt.bench.locomotion import PERFORM
from motionrt.bench.memory import peaks
from motionrt.bench.processes import run_module
from motionrt.bench.starts import cold_starts
from motionrt.bench.timing import Turns
from motionrt.bench.workload import SIZES
from motionrt.locomotion.crowd import FPS
from motionrt.models.threads import usable_cpus

Note = Callable[[str], None]
Found = dict[str, Any]
COLD_RUNS = 3


@dataclass(frozen=True)
class Plan:
    """What is to be measured.

    Attributes:
        threads: thread counts, each in a process of its own.
        models: the manifest or its folder, by default the shipped one.
        variant: which files of the models, by default those that the manifest prefers.
        against: names of rivals, which take turns with motionrt in the same process.
        only: names of benchmarks; None is all.
        sizes: of the galleries that are searched.
        turns: how often, and in which order.
        strict: time everything a second time, call by call in turn.
        limits: measure the machine's peaks, too, and how far every benchmark is from them.
        limit_s: for how long a benchmark runs for that.
        cold_runs: fresh processes for the cold start.
    """

    threads: Sequence[int] = (1, 2)
    models: str | None = None
    variant: str | None = None
    against: Sequence[str] = ()
    only: Sequence[str] | None = None
    sizes: Sequence[int] = SIZES
    turns: Turns = field(default_factory=Turns)
    strict: bool = False
    limits: bool = False
    limit_s: float = 1.0
    cold_runs: int = COLD_RUNS


def run_bench(plan: Plan, note: Note = lambda _: None) -> Found:
    """Measure; ``note`` is told what is going on.

    Raises:
        InvalidInputError: no benchmark has that name.
        MotionRTError: a benchmark process failed.
    """
    chosen(plan.only)  # before anything starts
    runs = [_run(plan, count, note) for count in plan.threads]
    return {
        "machine": machine(),
        "versions": versions(),
        "settings": {**asdict(plan.turns), "against": list(plan.against), "variant": plan.variant},
        "install_mb": install_sizes(),
        "runs": runs,
        "models": model_figures(runs),
    }


def _run(plan: Plan, threads: int, note: Note) -> Found:
    note(f"measuring, threads: {threads}")
    common = {"models": plan.models, "threads": threads, "variant": plan.variant}
    asked = {"against": list(plan.against), "turns": asdict(plan.turns), "strict": plan.strict, "sizes": plan.sizes}
    only = None if plan.only is None else list(plan.only)
    found = run_module("motionrt.bench.worker", {**common, **asked, "only": only})
    run = {"threads": threads, "cases": found["cases"], "left_out": found["left_out"], "called": found["models"]}
    if COLD in chosen(plan.only) and COLD not in found["left_out"]:
        note(f"starting cold, threads: {threads}")
        rivals = found["rival_cold_starts"]
        run["cold_start"] = cold_starts(plan.models, threads, plan.cold_runs, rivals, plan.variant)
        if threads == plan.threads[0]:
            run["peak_mb"] = peaks(plan.models, threads, plan.variant, list(found["left_out"]), plan.only)
    if plan.limits:
        note(f"looking for the limits, threads: {threads}")
        limits = run_module(
            "motionrt.bench.limits", {**common, "only": only, "sizes": plan.sizes, "seconds": plan.limit_s}
        )
        run["limits"] = {**limits, "benchmarks": against_times(limits["benchmarks"], found["cases"])}
    return {**run, **derived(found["cases"])}


def quick(plan: Plan) -> Plan:
    """The same with a few calls only: shows that it runs, not how fast."""
    return replace(plan, turns=Turns(rounds=1, calls=2, warm=1), limit_s=0.05, cold_runs=1)


def derived(cases: Sequence[Found]) -> Found:
    """What follows from the times: how many characters can be animated, and how fast a performance is made.

    ``characters_at_30_fps`` is 1000 / (30 x p50 in ms of a step of one character) in the best of the cases that walk.
    """
    walks = [case for case in cases if case["case"].startswith("walk,")]
    out: Found = {}
    if walks:
        best = min(walks, key=lambda case: case["p50_ms"])
        out["characters_at_30_fps"] = {
            "count": _characters(best["p50_ms"]),
            "case": best["case"],
            "against": {name: _crowd(ms, best["p50_ms"]) for name, ms in _best_rivals(walks).items()},
        }
    for case in cases:
        if case["case"] == PERFORM:
            out["perform_times_real_time"] = 1000 / (FPS * case["p50_ms"])
    return out


def _best_rivals(walks: Sequence[Found]) -> dict[str, float]:
    """Every rival's shortest time for a character."""
    found: dict[str, float] = {}
    for walk in walks:
        for name, timing in walk["against"].items():
            found[name] = min(timing["p50_ms"], found.get(name, float("inf")))
    return found


def _crowd(rival_ms: float, ours_ms: float) -> Found:
    return {"count": _characters(rival_ms), "ratio": rival_ms / ours_ms}


def _characters(p50_ms: float) -> int:
    return int(1000 / (FPS * p50_ms))


def model_figures(runs: Sequence[Found]) -> dict[str, Found]:
    """For the manifest: of every model that was called alone, p50, p95, and torch's p50 and ratio where it took part,
    at the first thread count.
    """
    if not runs:
        return {}
    cases = {case["case"]: case for case in runs[0]["cases"]}
    return {name: _figures(cases[graph_case(name)], call, runs[0]) for name, call in runs[0]["called"].items()}


def _figures(case: Found, call: str, run: Found) -> Found:
    found = {"p50_ms": case["p50_ms"], "p95_ms": case["p95_ms"]}
    if torch := case["against"].get("torch"):
        found |= {"torch_p50_ms": torch["p50_ms"], "ratio": torch["ratio"]}
    rounded = {name: round(value, 3) for name, value in found.items()}
    return {**rounded, "threads": run["threads"], "call": call}


def machine() -> Found:
    """The processor, and how many of its cores this process may use."""
    return {"system": platform.platform(), "processor": _processor(), "cores": usable_cpus()}


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that matter, where they are installed."""
    names = ("motionrt", "numpy", "onnxruntime", "tokenizers", "torch", "transformers")
    installed = {name: version for name in names if (version := _version(name)) is not None}
    return {"python": platform.python_version(), **installed}


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def rivals_of(found: Mapping[str, Any]) -> list[str]:
    """The rivals that took part, in the order in which they were asked for."""
    return list(found["settings"]["against"])
