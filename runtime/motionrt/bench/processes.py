"""Processes with a fixed number of threads: the benchmark itself, and cold starts."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from motionrt.errors import MotionRTError

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def run_worker(arguments: dict[str, Any]) -> dict[str, Any]:
    """The result of :mod:`motionrt.bench.worker` in a process of its own.

    Raises:
        MotionRTError: the process failed; the message is its last line.
    """
    command = [sys.executable, "-m", "motionrt.bench.worker", json.dumps(arguments)]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        encoding="utf-8",
        env=_environment(arguments["threads"]),
        check=False,
    )
    if done.returncode:
        raise MotionRTError(f"the benchmark failed: {_last_line(done.stderr)}")
    result: dict[str, Any] = json.loads(_last_line(done.stdout))
    return result


def cold_starts(models: str | None, threads: int, runs: int) -> dict[str, Any]:
    """Seconds from starting Python to the first embedded text, median of ``runs``, and peak memory."""
    arguments = json.dumps({"models": models, "threads": threads})
    command = [sys.executable, "-m", "motionrt.bench.first_answer", arguments]
    measured = [first_line(command, threads) for _ in range(runs)]
    memory: dict[str, Any] = {}
    for line in measured[0][1]:
        memory |= json.loads(line)
    return {
        "seconds": float(np.median([seconds for seconds, _ in measured])),
        "runs": runs,
        "peak_mb_text": memory.get("text_mb"),
        "peak_mb_text_and_motion": memory.get("motion_mb"),
    }


def first_line(command: Sequence[str], threads: int) -> tuple[float, list[str]]:
    """Seconds until a command prints its first line, and all lines that it prints.

    Raises:
        MotionRTError: it failed, or printed nothing.
    """
    started = time.perf_counter()
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env=_environment(threads),
    ) as process:
        first = process.stdout.readline() if process.stdout else ""
        seconds = time.perf_counter() - started
        rest, errors = process.communicate()
    if process.returncode or not first:
        raise MotionRTError(f"the cold start failed: {_last_line(errors)}")
    return seconds, [first, *rest.splitlines()]


def _environment(threads: int) -> dict[str, str]:
    return {**os.environ, **dict.fromkeys(_THREAD_VARIABLES, str(threads)), "PYTHONIOENCODING": "utf-8"}


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["no output"])[-1]
