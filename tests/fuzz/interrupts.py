"""Ctrl-C in the middle of long calls: how long each takes to end.

    python tests/fuzz/interrupts.py [CALL ...]

A process makes the call, this one sends SIGINT at several moments of it. Prints the longest wait by call, in seconds of
the processor, which other programs do not lengthen, and exits with 1 if one is above 0.2 s, a thread is left, or a
signal handler has changed.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "helpers")]

LIMIT_S = 0.2
MOMENTS = (0.15, 0.4, 0.75, 1.2)
"""Seconds after the start of a call."""
OTHERS = 10
"""How many times as long other programs may make a wait."""


LONG = {"embed_motion", "resample", "mirror", "positions", "save bvh", "save glb"}
"""Calls with a motion of a million frames."""


def calls(folder: Path, wanted: str = "") -> dict[str, Callable[[], object]]:
    """Calls of seconds to minutes, by name."""
    from motions import walking

    import motionrt
    from motionrt.locomotion import Path as Route

    runtime = motionrt.Runtime(threads=1)
    long, minutes = walking(1_000_000 if wanted in LONG else 10, fps=30.0), walking(20_000, fps=30.0)
    far = np.array([[0, 0], [0, 2000]], np.float32)
    rng = np.random.default_rng(0)
    walls = [[(x, z), (x + 2, z), (x + 2, z + 2), (x, z + 2)] for x, z in rng.uniform(-50, 48, (200, 2))]
    ground = [[(-60, -60), (60, -60), (60, 60), (-60, 60)]]

    # a Ctrl-C in the midst of an import is Python's affair: all that is needed is loaded first
    runtime.retrieve("walk", 1)
    runtime.walk((0, 0.5))
    runtime.pose({"right_wrist": (0.2, 1.2, 0.4)})
    runtime.generate("walk", 0.5, steps=1, seed=1)
    runtime.compose([minutes[:60]] * 2, ["left arm", "torso"])
    motionrt.load_motion(folder / "rig.bvh").retarget_to(folder / "rig.bvh")
    motionrt.Scene.from_polygons(ground, cell=1.0).random_path(5.0)

    def searched() -> None:
        for _ in range(100_000):
            runtime.retrieve("a person walks", 5)

    def planned() -> None:
        for seed in range(1000):
            motionrt.Scene.from_polygons(ground, walls, cell=0.1).random_path(200.0, seed)

    return {
        "walk": lambda: runtime.walk(path=Route(far)),
        "walk_together": lambda: runtime.walk_together([far] * 8),
        "stream": lambda: [frame for frame, _ in zip(runtime.stream((0, 1000)), range(10**6), strict=False)],
        "perform": lambda: runtime.perform(None, [motionrt.WalkTo(0.0, 1000.0)]),
        "pose": lambda: [runtime.pose({"right_wrist": (0.2, 0.1 + i / 1000, 0.6)}) for i in range(1000)],
        "generate": lambda: runtime.generate("a person walks", 8.0, n=1000, seed=1),
        "compose": lambda: [runtime.compose([minutes[:3000]] * 2, ["left arm", "torso"]) for _ in range(1000)],
        "retrieve": searched,
        "embed_motion": lambda: runtime.embed_motion(long),
        "build_gallery": lambda: runtime.build_gallery(folder / "library", folder / "one"),
        "build_gallery, two processes": lambda: runtime.build_gallery(folder / "library", folder / "two", jobs=2),
        "plan": planned,
        "resample": lambda: long.resample(60),
        "mirror": lambda: [long.mirror() for _ in range(100)],
        "positions": lambda: [long.positions() for _ in range(100)],
        "save bvh": lambda: long.save(folder / "long.bvh"),
        "save glb": lambda: [long.save(folder / "long.glb") for _ in range(100)],
        "load bvh": lambda: motionrt.load_motion(folder / "minutes.bvh"),
        "retarget_to": lambda: [minutes.retarget_to(folder / "rig.bvh") for _ in range(100)],
    }


def prepare(folder: Path) -> None:
    """Files that the calls read."""
    from motions import walking

    (folder / "library").mkdir()
    clip = walking(600, fps=30.0)
    for number in range(200):
        clip[number % 20 :].save(folder / "library" / f"{number}.npz")
    walking(60_000, fps=30.0).save(folder / "minutes.bvh")
    clip.save(folder / "rig.bvh")


def child(name: str, folder: Path) -> None:
    """Make one call once for every line of standard input; say when it began and when it was over."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where the tests run in the background
    call = calls(folder, name)[name]
    before = [signal.getsignal(number) for number in signal.valid_signals()]
    for _ in sys.stdin:
        outcome = "done"
        print("begins", flush=True)
        try:
            call()
        except KeyboardInterrupt:
            outcome = "interrupted"
        over, used = time.monotonic(), time.process_time()
        threads = [thread.name for thread in threading.enumerate() if thread is not threading.main_thread()]
        handlers = before != [signal.getsignal(number) for number in signal.valid_signals()]
        print(
            json.dumps({"outcome": outcome, "at": over, "used": used, "threads": threads, "handlers": handlers}),
            flush=True,
        )


def names(folder: Path) -> list[str]:
    """All calls."""
    done = subprocess.run(
        [sys.executable, __file__, "--names", str(folder)], capture_output=True, text=True, check=True
    )
    return list(json.loads(done.stdout))


def waits(name: str, folder: Path, moments: tuple[float, ...] = MOMENTS) -> tuple[list[float], list[str]]:
    """Seconds of the processor from each signal to the end of the call, and what is wrong beside that."""
    command = [sys.executable, __file__, "--child", name, str(folder)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "start_new_session": True}
    seconds, wrong = [], []
    with subprocess.Popen(command, **pipes) as process:  # type: ignore[call-overload]
        assert process.stdin
        assert process.stdout
        for moment in moments:
            print("go", file=process.stdin, flush=True)
            assert process.stdout.readline().strip() == "begins"
            time.sleep(moment)
            sent, used = time.monotonic(), _processor_seconds(process.pid)
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does it: all processes of the command
            said = json.loads(process.stdout.readline())
            if said["outcome"] == "interrupted":
                seconds.append(max(said["used"] - used, (said["at"] - sent) / OTHERS))
            else:
                wrong.append(f"over before {moment} s")
            wrong += [f"threads left: {said['threads']}"] if said["threads"] else []
            wrong += ["signal handlers changed"] if said["handlers"] else []
        process.stdin.close()
    return seconds, wrong


def _processor_seconds(pid: int) -> float:
    """What a process has used of the processor so far."""
    words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, words[11:13])) / os.sysconf("SC_CLK_TCK")


def main() -> int:
    """The command."""
    if sys.argv[1:2] == ["--child"]:
        child(sys.argv[2], Path(sys.argv[3]))
        return 0
    if sys.argv[1:2] == ["--names"]:
        print(json.dumps(list(calls(Path(sys.argv[2])))))
        return 0
    bad = False
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        prepare(folder)
        for name in sys.argv[1:] or names(folder):
            seconds, wrong = waits(name, folder)
            longest = max(seconds, default=float("nan"))
            bad |= not longest <= LIMIT_S or bool(wrong)
            print(
                f"{name:30s} {longest:6.3f} s  {' '.join(f'{wait:.3f}' for wait in seconds)}  {wrong or ''}", flush=True
            )
    return int(bad)


if __name__ == "__main__":
    sys.exit(main())
