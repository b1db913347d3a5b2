"""Processes with a fixed number of threads: the benchmark itself, and whatever has to start afresh."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any

from motionrt.errors import MotionRTError

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


def run_module(module: str, arguments: dict[str, Any]) -> dict[str, Any]:
    """What a module of motionrt.bench prints as its last line, JSON, in a process of its own.

    Args:
        module: its full name.
        arguments: become its only argument, as JSON; ``threads`` of them is what every library may use.

    Raises:
        MotionRTError: the process failed; the message is its last line.
    """
    done = subprocess.run(
        [sys.executable, "-m", module, json.dumps(arguments)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env=environment(arguments["threads"]),
        check=False,
    )
    if done.returncode:
        raise MotionRTError(f"the benchmark failed: {_last_line(done.stderr)}")
    result: dict[str, Any] = json.loads(_last_line(done.stdout))
    return result


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
        env=environment(threads),
    ) as process:
        first = process.stdout.readline() if process.stdout else ""
        seconds = time.perf_counter() - started
        rest, errors = process.communicate()
    if process.returncode or not first:
        raise MotionRTError(f"the cold start failed: {_last_line(errors)}")
    return seconds, [first, *rest.splitlines()]


def whole(command: Sequence[str], threads: int) -> float:
    """Seconds that a command takes from start to end; MotionRTError if it fails."""
    started = time.perf_counter()
    done = subprocess.run(
        command, capture_output=True, text=True, encoding="utf-8", env=environment(threads), check=False
    )
    seconds = time.perf_counter() - started
    if done.returncode:
        raise MotionRTError(f"{' '.join(command)} failed: {_last_line(done.stderr)}")
    return seconds


def environment(threads: int) -> dict[str, str]:
    """The environment of a process whose libraries may use so many threads."""
    return {**os.environ, **dict.fromkeys(_THREAD_VARIABLES, str(threads)), "PYTHONIOENCODING": "utf-8"}


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["no output"])[-1]
