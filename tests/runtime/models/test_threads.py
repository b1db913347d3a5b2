"""Threads: two unless asked for more, never more than affinity and container allow."""

from __future__ import annotations

from pathlib import Path

import pytest

from motionrt.errors import InvalidInputError
from motionrt.models import threads


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Pretend to be a machine with this many CPUs and these control group files."""

    def pretend(cpus: int, v2: str | None = None, v1: tuple[str, str] | None = None) -> None:
        monkeypatch.setattr(threads.os, "sched_getaffinity", lambda _: set(range(cpus)), raising=False)
        files = [tmp_path / name for name in ("cpu.max", "quota", "period")]
        for path, content in zip(files, (v2, *(v1 or (None, None))), strict=True):
            if content is not None:
                path.write_text(content, encoding="ascii")
        monkeypatch.setattr(threads, "_QUOTA_V2", files[0])
        monkeypatch.setattr(threads, "_QUOTA_V1", (files[1], files[2]))

    return pretend


@pytest.mark.parametrize(
    ("cpus", "v2", "v1", "usable"),
    [
        (16, None, None, 16),
        (16, "max 100000", None, 16),
        (16, "400000 100000", None, 4),
        (16, "50000 100000", None, 1),
        (2, "800000 100000", None, 2),
        (16, None, ("300000", "100000"), 3),
        (16, None, ("-1", "100000"), 16),
        (16, "nonsense", None, 16),
    ],
)
def test_usable_cpus_obey_affinity_and_container(machine, cpus: int, v2, v1, usable: int) -> None:
    machine(cpus, v2, v1)
    assert threads.usable_cpus() == usable
    assert threads.thread_count(None) == min(2, usable)


def test_without_affinity_the_cpu_count_is_taken(machine, monkeypatch: pytest.MonkeyPatch) -> None:
    machine(1)
    monkeypatch.delattr(threads.os, "sched_getaffinity")
    monkeypatch.setattr(threads.os, "cpu_count", lambda: None)
    assert threads.usable_cpus() == 1


def test_an_explicit_number_is_taken() -> None:
    assert threads.thread_count(5) == 5


@pytest.mark.parametrize("wrong", [0, -1, 1.5, "2", True])
def test_a_wrong_number_is_refused(wrong: object) -> None:
    with pytest.raises(InvalidInputError, match="threads must be a whole number from 1"):
        threads.thread_count(wrong)  # type: ignore[arg-type]
