"""A whole benchmark: the machine, every thread count, cold starts; as data and as text."""

from __future__ import annotations

import platform
import statistics
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from motionrt.bench.moves import PERFORM
from motionrt.bench.processes import cold_starts, first_line, run_worker
from motionrt.bench.roads import COLD, chosen
from motionrt.locomotion.walking import FPS
from motionrt.models.threads import usable_cpus

ROUNDS, CALLS, COLD_RUNS = 10, 10, 5
QUICK = (1, 2, 1)


def run_bench(
    threads: Sequence[int],
    *,
    models: str | None = None,
    against: str | None = None,
    quick: bool = False,
    only: Sequence[str] | None = None,
    note: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Measure the roads called ``only``, or all, at every thread count; ``note`` is told what is going on.

    Raises:
        InvalidInputError: no road has that name.
        MotionRTError: a benchmark process failed.
    """
    roads = list(chosen(only))
    rounds, calls, cold_runs = QUICK if quick else (ROUNDS, CALLS, COLD_RUNS)
    runs = []
    for count in threads:
        note(f"measuring, threads: {count}")
        asked = {"models": models, "threads": count, "against": against, "rounds": rounds, "calls": calls}
        found = run_worker({**asked, "only": roads})
        run = {"threads": count, "cases": found["cases"], "left_out": found["left_out"]}
        if COLD in roads and COLD not in found["left_out"]:
            note(f"starting cold, threads: {count}")
            run["cold_start"] = _cold(models, count, cold_runs, against, found["rival_cold_start"])
        runs.append({**run, **derived(found["cases"])})
    return {"machine": machine(), "versions": versions(), "runs": runs}


def _cold(
    models: str | None, threads: int, runs: int, against: str | None, rival: Sequence[str] | None
) -> dict[str, Any]:
    cold = cold_starts(models, threads, runs)
    if rival:
        seconds = _median_start(rival, threads, min(runs, 3))
        cold["against"] = {"name": against, "seconds": seconds, "ratio": seconds / cold["seconds"]}
    return cold


def _median_start(command: Sequence[str], threads: int, runs: int) -> float:
    return statistics.median(first_line(command, threads)[0] for _ in range(runs))


def machine() -> dict[str, Any]:
    """The processor, and how many of its cores this process may use."""
    return {"system": platform.platform(), "processor": _processor(), "cores": usable_cpus()}


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that matter, where they are installed."""
    names = ("motionrt", "numpy", "onnxruntime", "tokenizers", "torch")
    installed = {name: version for name in names if (version := _version(name)) is not None}
    return {"python": platform.python_version(), **installed}


def derived(cases: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What follows from the times: how many characters can be animated, and how fast a performance is made.

    ``characters_at_30_fps`` is 1000 / (30 x p50 in ms of a step of one character) in the best of the cases that walk.
    """
    walks = [case for case in cases if case["case"].startswith("walk,")]
    out: dict[str, Any] = {}
    if walks:
        best = min(walks, key=lambda case: case["p50_ms"])
        out["characters_at_30_fps"] = {"count": _characters(best), "case": best["case"]}
        rivals = [case["against"] for case in walks if "against" in case]
        if rivals:
            count = max(map(_characters, rivals))
            out["characters_at_30_fps"]["against"] = {"count": count, "ratio": rivals_ratio(best, rivals)}
    for case in cases:
        if case["case"] == PERFORM:
            out["perform_times_real_time"] = 1000 / (FPS * case["p50_ms"])
    return out


def rivals_ratio(best: dict[str, Any], rivals: Sequence[dict[str, Any]]) -> float:
    """The rival's best time over ours."""
    return float(min(rival["p50_ms"] for rival in rivals) / best["p50_ms"])


def _characters(timed: dict[str, Any]) -> int:
    return int(1000 / (FPS * timed["p50_ms"]))


def rows(run: dict[str, Any]) -> list[list[str]]:
    """Table rows of one thread count: what, p50, p95, rate, and the rival's p50 and the ratio.

    Times of walks are those of one character, times of performances those of one frame.
    """
    table = []
    for case in run["cases"]:
        p50 = case["p50_ms"]
        table.append([case["case"], _ms(p50), _ms(case["p95_ms"]), f"{1000 / p50:,.0f}/s", *_against(case, "p50_ms")])
    return table + _derived_rows(run) + (_cold_rows(run["cold_start"]) if "cold_start" in run else [])


def _derived_rows(run: dict[str, Any]) -> list[list[str]]:
    table = []
    if crowd := run.get("characters_at_30_fps"):
        other = crowd.get("against")
        against = [str(other["count"]), f"{other['ratio']:.1f} x"] if other else ["", ""]
        table.append([f"characters at 30 fps ({crowd['case']})", str(crowd["count"]), "", "", *against])
    if times := run.get("perform_times_real_time"):
        table.append(["perform, times real time", f"{times:.1f} x", "", "", "", ""])
    return table


def _cold_rows(cold: dict[str, Any]) -> list[list[str]]:
    against = _against(cold, "seconds", 1000)
    table = [["cold start to first text", _ms(cold["seconds"] * 1000), "", "", *against]]
    for key, label in (("peak_mb_text", "text"), ("peak_mb_text_and_motion", "text and motion")):
        if cold[key] is not None:
            table.append([f"peak memory, {label}", f"{cold[key]:.0f} MB", "", "", "", ""])
    return table


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _against(row: dict[str, Any], key: str, scale: float = 1.0) -> list[str]:
    other = row.get("against")
    return [_ms(other[key] * scale), f"{other['ratio']:.1f} x"] if other else ["", ""]


def _ms(value: float) -> str:
    return f"{value:.2f} ms" if value < 100 else f"{value:,.0f} ms"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
