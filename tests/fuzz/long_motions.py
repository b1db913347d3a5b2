"""Memory that long motions take, and how soon they hear Ctrl-C.

    python tests/fuzz/long_motions.py --frames 1000000 [CALL ...]

Every call runs in a process of its own. Prints by how many bytes a frame it grew at its peak, and for how many seconds
of the processor at most Ctrl-C would not have been heard; exits with 1 where either is beyond its limit.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "helpers")]

from motions import walking  # noqa: E402

from motionrt import Layer, Motion, Runtime, load_motion, render  # noqa: E402
from motionrt.formats.info import motion_file_info  # noqa: E402
from motionrt.locomotion import Goal, canonicalise  # noqa: E402
from motionrt.metrics import foot_skate  # noqa: E402
from motionrt.motion.attributes import measure  # noqa: E402
from motionrt.motion.events import events  # noqa: E402
from motionrt.motion.features import ccf219, guo263, sinc135  # noqa: E402
from motionrt.motion.feet.contacts import toe_contacts  # noqa: E402
from motionrt.motion.feet.flat_ground import flat_ground  # noqa: E402
from motionrt.motion.feet.lock import lock_feet  # noqa: E402
from motionrt.retrieval import Gallery, motion_features  # noqa: E402
from motionrt.synthesis.composing import compose  # noqa: E402

FRAME = (24 * 9 + 3) * 4
"""Bytes of a frame of a Motion."""
LIMIT = 4 * FRAME
"""Bytes that a call may take for every frame that it reads or makes: its result, twice (a Motion copies what it is
given), and as much again."""
FIXED = 200 << 20
LONGEST_S, TICK_S = 0.2, 0.005
"""Seconds of the processor for which no signal may be heard; of how often it is looked."""
LOOKED_THROUGH = 20_000
"""Frames in which a text is looked for: every window of them is embedded, which is hours for a million."""


def calls(folder: Path) -> dict[str, Callable[[Motion], object]]:
    """Every verb that takes a motion, by name."""
    step, rig = walking(30, fps=30.0), folder / "rig.bvh"
    step.save(rig)
    gallery = Gallery.from_motions([step], ["step"], Runtime(threads=1).model)

    def retargeted(motion: Motion) -> object:
        return motion.retarget_to(rig).save(folder / "rigged.bvh")

    def stored(suffix: str) -> dict[str, Callable[[Motion], object]]:
        file = folder / f"long{suffix}"
        return {f"save {suffix}": lambda motion: motion.save(file), f"load {suffix}": lambda _: load_motion(file)}

    return {
        "resample to 20 fps": lambda motion: motion.resample(20),
        "resample to 60 fps": lambda motion: motion.resample(60),
        "mirror": Motion.mirror,
        "canonical": Motion.canonical,
        "grounded": Motion.grounded,
        "in_place": Motion.in_place,
        "slice": lambda motion: motion[10:],
        "positions": Motion.positions,
        "goal frame": lambda motion: canonicalise(motion, Goal(1.0, 2.0, 0.5)),
        "sinc135": sinc135.encode,
        "ccf219": ccf219.encode,
        "guo263": guo263.encode,
        "features": motion_features,
        "attributes": measure,
        "events": events,
        "flat ground": flat_ground,
        "lock_feet": lambda motion: lock_feet(motion, toe_contacts(motion)),
        "foot skate": lambda motion: foot_skate(motion.positions()),
        "notebook": Motion._repr_html_,
        "render": lambda motion: render(motion, folder / "long.png"),
        "compose": lambda motion: compose([Layer(motion, ["left arm"]), Layer(step, ["torso"])]),
        "embed_motion": lambda motion: Runtime(threads=1).embed_motion(motion),
        "similar": lambda motion: Runtime(threads=1).similar(motion, 1, gallery),
        "describe": lambda motion: Runtime(threads=1).describe(motion, 1),
        "moments": lambda motion: Runtime(threads=1).moments("a person walks", motion[:LOOKED_THROUGH], lengths=[60]),
        "transition": lambda motion: Runtime(threads=1).transition(motion, step[:1]),
        "retarget_to": retargeted,
        **stored(".bvh"),
        "info": lambda _: motion_file_info(folder / "long.bvh"),
        **stored(".glb"),
        **stored(".npz"),
        "build_gallery": lambda _: Runtime(threads=1).build_gallery(_alone(folder / "long.npz"), folder / "gallery"),
    }


def _alone(file: Path) -> Path:
    folder = file.with_name("alone")
    folder.mkdir()
    file.rename(folder / file.name)
    return folder


def grown(call: Callable[[Motion], object], motion: Motion, *, traced: bool = False) -> tuple[int, float, str]:
    """Bytes by which a process grows at its peak, beyond the motion that it is given; the longest wait, if traced."""
    ours, theirs = os.pipe()
    if (pid := os.fork()) == 0:
        longest = LongestWait()
        try:
            Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # the peak begins anew
            before = _kilobytes("VmHWM")
            if traced:
                longest.start()
            call(motion)
            longest.stop()
            said: Any = [(_kilobytes("VmHWM") - before) * 1024, longest.seconds, longest.place]
        except Exception as error:  # noqa: BLE001  # whatever it is, it is told
            said = [0, 0.0, f"{type(error).__name__}: {error}"[:300]]
        os.write(theirs, json.dumps(said).encode())
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours) as pipe:
        text = pipe.read()
    os.waitpid(pid, 0)
    size, seconds, place = json.loads(text or '[0, 0, "the process died"]')
    return size, seconds, place


class LongestWait:
    """The longest time, in seconds of the processor, between two moments when Python hears signals, and where it ended.

    A timer signals every few milliseconds; nothing is slowed down by that.
    """

    def __init__(self) -> None:
        self.seconds, self.place = 0.0, ""
        self._since = time.process_time()

    def start(self) -> None:
        """From now on."""
        signal.signal(signal.SIGPROF, self._heard)
        self._since = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, TICK_S, TICK_S)

    def stop(self) -> None:
        """Until now."""
        signal.setitimer(signal.ITIMER_PROF, 0)
        self.seconds = max(self.seconds, TICK_S)

    def _heard(self, _: int, frame: Any) -> None:
        waited = time.process_time() - self._since
        if waited > self.seconds and frame is not None:
            self.seconds, self.place = waited, f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"
        self._since = time.process_time()


def _kilobytes(name: str) -> int:
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(f"{name}:"))


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("calls", nargs="*", metavar="CALL", help="default: all")
    parser.add_argument("--frames", type=int, default=1_000_000)
    given = parser.parse_args()
    motion, bad = walking(given.frames, fps=30.0), []
    with tempfile.TemporaryDirectory() as made:
        for name, call in calls(Path(made)).items():
            if given.calls and name not in given.calls:
                continue
            size, seconds, place = grown(call, motion, traced=True)
            rate = f"{size / given.frames:7.0f} bytes a frame"
            print(f"{name:20s} {size / 2**20:8.0f} MiB  {rate}  {seconds:6.3f} s  {place}", flush=True)
            bad += [name] if size > LIMIT * given.frames + FIXED or seconds > LONGEST_S or not seconds else []
    print(f"beyond {LIMIT} bytes a frame or {LONGEST_S} s: {', '.join(bad) or 'none'}")
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
