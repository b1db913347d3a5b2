"""A fresh process that runs some benchmarks once; prints its peak memory."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from typing import Any

from motionrt.bench.first_answer import peak_mb
from motionrt.bench.processes import run_module
from motionrt.errors import MotionRTError

GROUPS = {
    "import": (),
    "text": ("text",),
    "text and motion": ("text", "motion"),
    "query over 10,000 clips": ("retrieve",),
    "generate": ("generate",),
    "walk": ("walk",),
    "pose": ("pose",),
    "perform": ("perform",),
}


def peaks(
    models: str | None, threads: int, variant: str | None, left_out: Sequence[str], only: Sequence[str] | None
) -> dict[str, float]:
    """MB by group of benchmarks, each in a process of its own; groups with a benchmark that is left out are, too."""
    found = {}
    for group, benchmarks in GROUPS.items():
        if any(benchmark in left_out or (only is not None and benchmark not in only) for benchmark in benchmarks):
            continue
        asked = {"models": models, "threads": threads, "variant": variant, "benchmarks": benchmarks}
        peak = run_module("motionrt.bench.memory", asked)["peak_mb"]
        if peak is not None:
            found[group] = peak
    return found


def run_once(models: str | None, threads: int, variant: str | None, benchmarks: Sequence[str]) -> None:
    """Every case of the benchmarks, once."""
    from contextlib import closing

    from motionrt.bench.setting import Setting
    from motionrt.bench.worker import prepared
    from motionrt.bench.workload import Workload

    with closing(Setting(models, threads, Workload.standard((10_000,)), variant=variant)) as setting:
        for case in prepared(setting, benchmarks)[0].values():
            case.call()


def main() -> int:
    """``python -m motionrt.bench.memory '{"models": null, "threads": 1, "variant": null, "benchmarks": ["text"]}'``."""
    arguments: dict[str, Any] = json.loads(sys.argv[1])
    try:
        if arguments["benchmarks"]:
            run_once(**arguments)
        else:
            import motionrt.runtime  # noqa: F401
    except MotionRTError as error:
        print(error, file=sys.stderr)
        return 1
    print(json.dumps({"peak_mb": peak_mb()}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
