"""How many threads a model may use: 2 unless asked for more, and never more than the process may."""

from __future__ import annotations

import os
from pathlib import Path

from motionrt.errors import InvalidInputError

DEFAULT_MOST = 2
_QUOTA_V2 = Path("/sys/fs/cgroup/cpu.max")
_QUOTA_V1 = Path("/sys/fs/cgroup/cpu/cpu.cfs_quota_us"), Path("/sys/fs/cgroup/cpu/cpu.cfs_period_us")


def thread_count(threads: int | None) -> int:
    """``threads`` itself when given, else at most 2 of the CPUs that the process may use.

    Raises:
        InvalidInputError: ``threads`` is not a whole number above 0.
    """
    if threads is None:
        return min(DEFAULT_MOST, usable_cpus())
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise InvalidInputError(f"threads must be a whole number from 1, not {threads!r}")
    return threads


def usable_cpus() -> int:
    """CPUs by affinity and container quota, at least 1."""
    affinity = getattr(os, "sched_getaffinity", None)
    count = len(affinity(0)) if affinity is not None else os.cpu_count() or 1
    quota = _container_quota()
    return max(1, count if quota is None else min(count, int(quota)))


def _container_quota() -> float | None:
    """CPUs that the control group of a container allows, or None without a limit."""
    try:
        quota, period = _QUOTA_V2.read_text(encoding="ascii").split()
    except (OSError, ValueError):
        return _container_quota_v1()
    return None if quota == "max" else int(quota) / int(period)


def _container_quota_v1() -> float | None:
    try:
        quota, period = (int(path.read_text(encoding="ascii")) for path in _QUOTA_V1)
    except (OSError, ValueError):
        return None
    return quota / period if quota > 0 else None
