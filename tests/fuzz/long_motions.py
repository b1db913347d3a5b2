"""Memory that long motions take: ``python tests/fuzz/long_motions.py --frames 1000000``.

Every call runs in a process of its own. Prints by how many bytes a frame it grew at its peak, beside what its result
holds, and exits with 1 where that is more than the limit.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "helpers")]

from motions import walking  # noqa: E402

from motionrt import Motion, load_motion  # noqa: E402

FRAME = (24 * 9 + 3) * 4
"""Bytes of a frame of a Motion."""
LIMIT = 4 * FRAME
"""Bytes that a call may take for every frame that it reads or makes: its result, twice (a Motion copies what it is
given), and as much again."""
FIXED = 200 << 20


def calls(folder: Path) -> dict[str, Callable[[Motion], object]]:
    """Calls by name."""
    return {
        "resample to 20 fps": lambda motion: motion.resample(20),
        "mirror": Motion.mirror,
        "canonical": Motion.canonical,
        "positions": Motion.positions,
        "save bvh": lambda motion: motion.save(folder / "long.bvh"),
        "save glb": lambda motion: motion.save(folder / "long.glb"),
        "save npz": lambda motion: motion.save(folder / "long.npz"),
        "load bvh": lambda motion: load_motion(folder / "long.bvh"),
        "load glb": lambda motion: load_motion(folder / "long.glb"),
        "load npz": lambda motion: load_motion(folder / "long.npz"),
    }


def grown(call: Callable[[Motion], object], frames: int) -> int:
    """Bytes by which a process grows at its peak, beyond the motion that it is given."""
    ours, theirs = os.pipe()
    if (pid := os.fork()) == 0:
        motion = walking(frames, fps=30.0)
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # the peak begins anew
        before = _kilobytes("VmHWM")
        call(motion)
        os.write(theirs, str((_kilobytes("VmHWM") - before) * 1024).encode())
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours) as pipe:
        said = pipe.read()
    os.waitpid(pid, 0)
    return int(said)


def _kilobytes(name: str) -> int:
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(f"{name}:"))


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=1_000_000)
    frames = parser.parse_args().frames
    bad = []
    with tempfile.TemporaryDirectory() as made:
        for name, call in calls(Path(made)).items():
            size = grown(call, frames)
            print(f"{name:20s} {size / 2**20:8.0f} MiB  {size / frames:7.0f} bytes a frame", flush=True)
            bad += [name] if size > LIMIT * frames + FIXED else []
    print(f"beyond {LIMIT} bytes a frame: {', '.join(bad) or 'none'}")
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
