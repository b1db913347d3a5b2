"""A whole benchmark: the machine, every thread count, cold starts; as data and as text."""

from __future__ import annotations

import platform
import statistics
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from motionrt.bench.processes import cold_starts, first_line, run_worker
from motionrt.models.threads import usable_cpus

ROUNDS, CALLS, COLD_RUNS = 10, 10, 5
QUICK = (1, 2, 1)


def run_bench(
    threads: Sequence[int],
    *,
    models: str | None = None,
    against: str | None = None,
    quick: bool = False,
    note: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Measure everything at every thread count; ``note`` is told what is going on.

    Raises:
        MotionRTError: a benchmark process failed.
    """
    rounds, calls, cold_runs = QUICK if quick else (ROUNDS, CALLS, COLD_RUNS)
    runs = []
    for count in threads:
        note(f"measuring, threads: {count}")
        asked = {"models": models, "threads": count, "against": against, "rounds": rounds, "calls": calls}
        found = run_worker(asked)
        note(f"starting cold, threads: {count}")
        cold = cold_starts(models, count, cold_runs)
        if found["rival_cold_start"]:
            seconds = _median_start(found["rival_cold_start"], count, min(cold_runs, 3))
            cold["against"] = {"name": against, "seconds": seconds, "ratio": seconds / cold["seconds"]}
        runs.append({"threads": count, "cases": found["cases"], "cold_start": cold})
    return {"machine": machine(), "versions": versions(), "runs": runs}


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


def rows(run: dict[str, Any]) -> list[list[str]]:
    """Table rows of one thread count: what, p50, p95, rate, and the rival's p50 and the ratio."""
    table = []
    for case in run["cases"]:
        p50 = case["p50_ms"]
        table.append([case["case"], _ms(p50), _ms(case["p95_ms"]), f"{1000 / p50:,.0f}/s", *_against(case, "p50_ms")])
    cold = run["cold_start"]
    against = _against(cold, "seconds", 1000)
    table.append(["cold start to first text", _ms(cold["seconds"] * 1000), "", "", *against])
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
