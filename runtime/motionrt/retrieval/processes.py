"""Work in several processes, each with a pipe of its own: one that dies is noticed at once, whatever it was doing.

In a pool that shares its queues a process that is killed while it writes an answer leaves half of it there, and the
others waiting for ever.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from motionrt.errors import GalleryError

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import SpawnProcess

Job = TypeVar("Job")
Result = TypeVar("Result")
_PATIENCE_S = 2.0  # that a process gets to end by itself


def in_processes(
    jobs: Sequence[Job], make: Callable[[], Callable[[Job], Result]], count: int
) -> Generator[Result, None, None]:
    """The results of ``jobs`` in their order.

    Args:
        jobs: what to do; must survive pickling.
        make: called once in every process; what it gives is called with every job.
        count: how many processes, which are spawned.

    Raises:
        GalleryError: a process ended early.
    """
    crew: dict[Connection, SpawnProcess] = {}
    try:
        for _ in range(count):
            _start(crew, make)
        yield from _in_order(_answers(crew, jobs), len(jobs))
    finally:
        _end(crew)


def _start(crew: dict[Connection, SpawnProcess], make: Callable[[], Callable[[Any], Any]]) -> None:
    import multiprocessing  # slow to import, and seldom needed

    spawning = multiprocessing.get_context("spawn")
    ours, theirs = spawning.Pipe()
    process = spawning.Process(target=_serve, args=(theirs, make), daemon=True)
    process.start()
    theirs.close()  # so that only the process holds it, and its death is the end of the pipe
    crew[ours] = process


def _answers(crew: dict[Connection, SpawnProcess], jobs: Sequence[Job]) -> Iterator[tuple[int, Any]]:
    """Number and result of every job as they come; everybody always has one job, and never more."""
    from multiprocessing.connection import wait

    waiting = iter(enumerate(jobs))
    busy = [pipe for pipe in crew if _give(pipe, waiting)]
    while busy:
        ready = wait(busy)
        for pipe in [pipe for pipe in busy if pipe in ready]:
            try:
                answer: tuple[int, Any] = pipe.recv()
                if not _give(pipe, waiting):
                    busy.remove(pipe)
            except (EOFError, OSError) as error:
                raise GalleryError("a process of the build ended early (out of memory?); try fewer --jobs") from error
            yield answer


def _give(pipe: Connection, waiting: Iterator[tuple[int, Any]]) -> bool:
    job = next(waiting, None)
    if job is not None:
        pipe.send(job)
    return job is not None


def _in_order(answers: Iterator[tuple[int, Any]], count: int) -> Iterator[Any]:
    early: dict[int, Any] = {}
    for number in range(count):
        while number not in early:
            place, result = next(answers)
            early[place] = result
        yield early.pop(number)


def _serve(pipe: Connection, make: Callable[[], Callable[[Any], Any]]) -> None:
    """The life of a process: until nobody is at the other end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's, which then ends its processes
    work = make()
    while True:
        try:
            number, job = pipe.recv()
        except (EOFError, OSError):
            return
        pipe.send((number, work(job)))


def _end(crew: dict[Connection, SpawnProcess]) -> None:
    for pipe in crew:
        pipe.close()
    for process in crew.values():
        process.terminate()
    for process in crew.values():
        process.join(_PATIENCE_S)
        if process.is_alive():
            process.kill()
            process.join(_PATIENCE_S)
