"""One door in a process of its own, with a limit on its time and its memory: what came out, and what it cost."""

from __future__ import annotations

import gc
import io
import os
import pickle
import resource
import select
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from doors import DOORS

CPU_S, MEMORY_MB, WALL_S = 2.0, 512, 120.0
BATCH, GREW_MB = 100, 64

Prepared = Callable[[int], tuple[str, Path]]
"""Writes the file of a case; the door it is for, and where it is."""


@dataclass(frozen=True)
class Outcome:
    """What a door made of a file.

    Attributes:
        kind: ``loaded``, ``typed``, ``untyped`` or ``killed``.
        error: the name of the error's class.
        message: its words.
        cpu_s: CPU seconds.
        memory_mb: MiB that the process grew by.
    """

    kind: str
    error: str = ""
    message: str = ""
    cpu_s: float = 0.0
    memory_mb: float = 0.0

    @property
    def good(self) -> bool:
        """Read or refused, at a cost that a small file may have."""
        modest = self.cpu_s <= CPU_S and self.memory_mb <= MEMORY_MB
        return self.kind in {"loaded", "typed"} and modest and len(self.message) <= 2000


def measured(door: str, path: Path) -> Outcome:
    """Call a door in a forked process; the process has all modules already, so that only the file counts."""
    ours, theirs = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(ours)
        _child(door, path, theirs)
    os.close(theirs)
    said = _heard(ours, pid)
    os.close(ours)
    _, status, used = os.wait4(pid, 0)
    cpu = used.ru_utime + used.ru_stime
    if not said:
        return Outcome("killed", f"signal {os.WTERMSIG(status)}" if os.WIFSIGNALED(status) else "exit", cpu_s=cpu)
    outcome: Outcome = pickle.loads(said)
    return outcome


def measured_all(cases: Sequence[int], prepared: Prepared) -> Iterator[tuple[int, Outcome]]:
    """Cases and their outcomes, in order.

    A process takes one case after the other until one is not good or makes it grow. A case that is not good, or whose
    process died, is measured once more in a process of its own.
    """
    left = list(cases)
    while left:
        outcomes = _batch(left[:BATCH], prepared)
        if outcomes and not outcomes[-1].good:
            del outcomes[-1]
        alone = not outcomes or (len(outcomes) < len(left[:BATCH]) and outcomes[-1].memory_mb <= GREW_MB)
        yield from zip(left, outcomes, strict=False)
        left = left[len(outcomes) :]
        if alone:
            yield left[0], measured(*prepared(left[0]))
            del left[0]


def warm() -> None:
    """Import what the doors import, so that no case pays for it."""
    import csv  # noqa: F401
    import zipfile  # noqa: F401

    import scipy.ndimage
    import scipy.sparse.csgraph
    import scipy.spatial  # noqa: F401
    import yaml  # noqa: F401

    import motionrt.formats
    import motionrt.locomotion
    import motionrt.locomotion.scene
    import motionrt.locomotion.words
    import motionrt.models.reading
    import motionrt.models.text
    import motionrt.retrieval.gallery
    import motionrt.synthesis.parts  # noqa: F401

    try:
        import PIL.Image
        import trimesh
        import ufbx  # noqa: F401

        PIL.Image.init()
        assert trimesh.available_formats()
    except ImportError:
        pass
    gc.freeze()  # a collection in a child would copy all of its pages


def _child(door: str, path: Path, pipe: int) -> None:
    os.write(pipe, pickle.dumps(_called(door, path)))
    os._exit(0)


def _batch(cases: list[int], prepared: Prepared) -> list[Outcome]:
    """Outcomes of the first cases: all of them unless one is not good, grows the process or ends it."""
    ours, theirs = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(ours)
        for case in cases:
            outcome = _called(*prepared(case))
            os.write(theirs, pickle.dumps(outcome))
            if not outcome.good or outcome.memory_mb > GREW_MB:
                break
        os._exit(0)
    os.close(theirs)
    said = io.BytesIO(_heard(ours, pid))
    os.close(ours)
    os.waitpid(pid, 0)
    outcomes = []
    while said.tell() < len(said.getbuffer()):
        outcomes.append(pickle.load(said))
    return outcomes


def _called(door: str, path: Path) -> Outcome:
    """What a door makes of a file, in this process, which is limited from now on."""
    from motionrt.errors import MotionRTError

    limit = int(time.process_time() + CPU_S * 5)
    resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))
    ceiling = _virtual() + 4 * MEMORY_MB * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (ceiling, resource.RLIM_INFINITY))
    before, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    kind, error, message = "loaded", "", ""
    try:
        DOORS[door](path)
    except MotionRTError as refused:
        kind, error, message = "typed", type(refused).__name__, str(refused)
    except BaseException as other:  # noqa: BLE001  # it is told
        kind, error, message = "untyped", type(other).__name__, str(other)[:300]
    memory = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    return Outcome(kind, error, message[:50_000], time.process_time() - began, memory)


def _heard(pipe: int, pid: int) -> bytes:
    parts = []
    while True:
        ready, _, _ = select.select([pipe], [], [], WALL_S)
        if not ready:
            os.kill(pid, signal.SIGKILL)
            return b"".join(parts)
        block = os.read(pipe, 1 << 16)
        if not block:
            return b"".join(parts)
        parts.append(block)


def _virtual() -> int:
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
