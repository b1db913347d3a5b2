"""Work in the background of one window: it tells how far it is, can be cancelled, and its errors go to the page."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TypeVar

Told = Callable[[int, int, str], None]
T = TypeVar("T")
Work = Callable[[Told], T]
"""Something that takes time; it calls what it gets (done, of, words) now and then, which may raise Cancelled."""
_PATIENCE_S = 0.1


class Cancelled(Exception):  # noqa: N818  (nothing is wrong)
    """The user does not want it any more."""


class Jobs:
    """Runs one job at a time.

    Args:
        desk: held while a job runs: windows that share models take turns.
        on_progress: told a share from 0 to 1, and what is being done.
    """

    def __init__(self, desk: threading.Lock, on_progress: Callable[[float, str], None]) -> None:
        self._desk, self._on_progress = desk, on_progress
        self._thread: threading.Thread | None = None
        self._cancelled = threading.Event()

    @property
    def busy(self) -> bool:
        """Whether a job runs or waits."""
        return self._thread is not None and self._thread.is_alive()

    def start(
        self,
        work: Work[T],
        done: Callable[[T, float], None],
        failed: Callable[[BaseException], None],
        ended: Callable[[], None],
    ) -> bool:
        """Begin, unless something is running: False then.

        Args:
            work: what to do.
            done: gets the result, and how many seconds it took.
            failed: gets the error, Cancelled among them.
            ended: is called last, in either case.
        """
        if self.busy:
            return False
        self._cancelled.clear()
        self._thread = threading.Thread(target=self._run, args=(work, done, failed, ended), daemon=True)
        self._thread.start()
        return True

    def cancel(self) -> None:
        """Ask the job to end; it does at its next word."""
        self._cancelled.set()

    def wait(self, seconds: float | None = None) -> bool:
        """Until the job has ended; whether it has."""
        if self._thread is not None:
            self._thread.join(seconds)
        return not self.busy

    def _told(self, done: int, total: int, words: str) -> None:
        if self._cancelled.is_set():
            raise Cancelled
        self._on_progress(min(max(done / max(total, 1), 0.0), 1.0), words)

    def _run(
        self,
        work: Work[T],
        done: Callable[[T, float], None],
        failed: Callable[[BaseException], None],
        ended: Callable[[], None],
    ) -> None:
        try:
            self._take_turn()
            try:
                began = time.perf_counter()
                result = work(self._told)
            finally:
                self._desk.release()
            self._told(1, 1, "")
            done(result, time.perf_counter() - began)
        except BaseException as error:  # noqa: BLE001  whatever it is, the page is told and goes on
            failed(error)
        finally:
            ended()

    def _take_turn(self) -> None:
        while not self._desk.acquire(timeout=_PATIENCE_S):
            self._told(0, 1, "waiting for another window")
