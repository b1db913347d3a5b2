"""A character in a game's loop: 60 pictures a second out of 30 frames a second, made by a thread of its own.

Try it: ``python examples/game_loop.py``.

`Live` is the pattern to copy: one thread owns the stream, the game never waits for it, and all that the game asks
(a new goal, the pose now) may be asked from any thread.
"""

from __future__ import annotations

import queue
import threading
import time
from dataclasses import dataclass

import numpy as np

import motionrt
from motionrt.motion.rotations import matrix_to_quaternion, slerp
from motionrt.motion.skeleton import FloatArray

FPS = 30.0  # of the stream
AHEAD = 3  # frames that are ready before they are due: 0.1 s, more than the longest pause of the stream


@dataclass(frozen=True)
class Pose:
    """Local rotations ``(24, 4)`` wxyz and the pelvis ``(3,)`` in metres: what a game engine wants."""

    quaternions: FloatArray
    root: FloatArray


class Live:
    """A walking character that can be asked for its pose at any time; use it in a ``with``."""

    def __init__(self, runtime: motionrt.Runtime, goal: motionrt.Goal) -> None:
        self._runtime = runtime
        self._frames: queue.Queue[Pose | Exception] = queue.Queue(AHEAD)
        self._goal, self._changed, self._stop = goal, False, threading.Event()
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._make, name="motionrt", daemon=True)
        self._thread.start()
        self._before, self._after, self._time = self._take(), self._take(), 0.0

    def __enter__(self) -> Live:  # noqa: PYI034  # typing.Self needs Python 3.11
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def aim(self, goal: motionrt.Goal) -> None:
        """Walk somewhere else; from any thread."""
        with self._lock:
            self._goal, self._changed = goal, True

    def advance(self, seconds: float) -> Pose:
        """The pose that many seconds after the last one; an error of the stream is raised here."""
        self._time += seconds * FPS
        while self._time >= 1:
            self._before, self._after = self._after, self._take()
            self._time -= 1
        return between(self._before, self._after, self._time)

    def _take(self) -> Pose:
        made = self._frames.get()  # waits only if the game asks faster than frames can be made
        if isinstance(made, Exception):
            raise made
        return made

    def _make(self) -> None:
        try:
            frames = self._runtime.stream(self._goal)
            made = next(frames)
            while not self._stop.is_set():
                self._offer(Pose(matrix_to_quaternion(made.rotations[0]), made.root[0]))
                with self._lock:
                    told, self._changed = (self._goal if self._changed else None), False
                made = frames.send(told)
        except Exception as error:  # noqa: BLE001  # the game's thread raises it
            self._offer(error)

    def _offer(self, made: Pose | Exception) -> None:
        while not self._stop.is_set():
            try:
                self._frames.put(made, timeout=0.1)
            except queue.Full:
                continue
            return


def between(a: Pose, b: Pose, weight: float) -> Pose:
    """Spherical between rotations, straight between positions; ``weight`` 0 to 1."""
    return Pose(slerp(a.quaternions, b.quaternions, weight), (1 - weight) * a.root + weight * b.root)


def main() -> None:
    """Two seconds of a game at 60 Hz; the goal changes after one."""
    with Live(motionrt.Runtime(threads=1), motionrt.Goal(0.0, 4.0)) as character:
        slowest, clock = 0.0, time.perf_counter()
        for picture in range(120):
            if picture == 60:
                character.aim(motionrt.Goal(3.0, 2.0, heading=np.pi / 2))
            began = time.perf_counter()
            pose = character.advance(1 / 60)
            slowest = max(slowest, time.perf_counter() - began)
            if picture % 20 == 0:
                print(f"{picture / 60:4.1f} s  pelvis at {pose.root.round(2)} m")
            time.sleep(max(0.0, clock + (picture + 1) / 60 - time.perf_counter()))
        print(f"the game waited {1000 * slowest:.1f} ms at most for a pose")


if __name__ == "__main__":
    main()
