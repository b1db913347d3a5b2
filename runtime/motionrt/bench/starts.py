"""Cold starts: fresh processes up to their first answer, ours and the rivals' in turn."""

from __future__ import annotations

import json
import statistics
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from motionrt.bench.processes import first_line, whole
from motionrt.bench.workload import TEXTS
from motionrt.errors import MotionRTError

Command = Sequence[str]


def cold_starts(
    models: str | None, threads: int, runs: int, rivals: Mapping[str, Command], variant: str | None = None
) -> dict[str, Any]:
    """Medians over ``runs`` fresh processes, all in turn, of:

    ``seconds`` from starting Python to the first embedded text, ``import_s`` of motionrt's runtime, ``python_s`` of a
    Python that does nothing, ``retrieve_s`` of the whole command ``motionrt retrieve`` on the starter gallery (``None``
    where that cannot be asked with these models), the rivals' seconds under ``against``, and the peak memory of each.
    """
    asked = json.dumps({"models": models, "threads": threads, "variant": variant})
    ours = [sys.executable, "-m", "motionrt.bench.first_answer", asked]
    starts: dict[str, list[tuple[float, list[str]]]] = {name: [] for name in ("motionrt", *rivals)}
    others: dict[str, list[float | None]] = {"python_s": [], "retrieve_s": []}
    for _ in range(runs):
        for name, command in {"motionrt": ours, **rivals}.items():
            starts[name].append(first_line(command, threads))
        others["python_s"].append(whole([sys.executable, "-c", "pass"], threads))
        others["retrieve_s"].append(_retrieve(models, threads, variant))
    said = [_said(lines) for _, lines in starts["motionrt"]]
    seconds = _median_seconds(starts["motionrt"])
    return {
        "seconds": seconds,
        "runs": runs,
        "import_s": statistics.median(each["import_s"] for each in said),
        **{name: _median(values) for name, values in others.items()},
        "peak_mb": said[0]["peak_mb"],
        "against": {name: _rival(starts[name], seconds) for name in rivals},
    }


def _rival(starts: Sequence[tuple[float, list[str]]], ours: float) -> dict[str, Any]:
    seconds = _median_seconds(starts)
    return {"seconds": seconds, "ratio": seconds / ours, "peak_mb": _said(starts[0][1]).get("peak_mb")}


def _median_seconds(starts: Sequence[tuple[float, list[str]]]) -> float:
    return statistics.median(seconds for seconds, _ in starts)


def _median(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return statistics.median(known) if known else None


def _retrieve(models: str | None, threads: int, variant: str | None) -> float | None:
    """The shipped models alone can search the starter gallery."""
    if models is not None or variant is not None:
        return None
    command = [sys.executable, "-m", "motionrt", "retrieve", TEXTS[0], "--threads", str(threads)]
    try:
        return whole(command, threads)
    except MotionRTError:
        return None


def _said(lines: Sequence[str]) -> dict[str, Any]:
    """What a process says of itself in JSON; nothing, where its lines are something else."""
    found: dict[str, Any] = {}
    for line in lines:
        if line.startswith("{"):
            found |= json.loads(line)
    return found
