"""A process that builds or updates a gallery and is killed at its n-th step on the disk.

    python tests/fuzz/kills.py --kills 200 [--first CLIPS]

makes so many kills, at every step of builds and updates of galleries of 2 (or CLIPS), 3, 4 ... clips, and exits with 1
if one of them leaves anything but no gallery, the old one or the new one. Its processes are forked: nothing is imported
again, and a kill takes some hundredths of a second.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

HERE = Path(__file__).parent
STEPS = ("open", "os.rename", "os.remove", "os.mkdir")
"""Audit events at which it is killed: every file that is opened for writing, renamed, removed; every folder made."""

CHILD = """
import os, signal, sys
sys.path[:0] = {paths!r}
from fake_embedder import open_fake
from motionrt.retrieval import build_gallery, update_gallery
import motionrt.formats, motionrt.retrieval.layout
left, target = {step}, {target!r}
def hook(event, arguments):
    global left
    if event not in {steps!r} or not isinstance(arguments[0], (str, os.PathLike)): return
    if event == "open" and not (isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR)): return
    if target not in str(arguments[0]): return
    left -= 1
    if left < 0: os.kill(os.getpid(), signal.SIGKILL)
sys.addaudithook(hook)
if {verb!r} == "build": build_gallery({source!r}, open_fake, out=target)
else: update_gallery(target, open_fake)
"""


def killed_at(step: int, verb: str, source: Path, target: Path) -> bool:
    """Whether the process died at that step; otherwise it had fewer, and has done its work."""
    paths = [str(HERE.parent / "helpers"), *sys.path]
    code = CHILD.format(paths=paths, step=step, target=str(target), steps=STEPS, verb=verb, source=str(source))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=os.environ)
    if done.returncode not in (0, -signal.SIGKILL):
        raise AssertionError(done.stderr[-2000:])
    return done.returncode != 0


def killed_in_fork(step: int, verb: str, source: Path, target: Path) -> bool:
    """The same in a forked process."""
    code = CHILD.format(paths=[], step=step, target=str(target), steps=STEPS, verb=verb, source=str(source))
    if (pid := os.fork()) == 0:
        try:
            exec(compile(code, "killed", "exec"), {})  # it is the text above
        except BaseException:  # noqa: BLE001  # it is told by the exit code
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if status not in (0, -signal.SIGKILL):
        raise AssertionError(f"step {step} of {verb} ended with {status}")
    return status != 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=200, metavar="N", help="default: %(default)s")
    parser.add_argument("--first", type=int, default=2, metavar="CLIPS", help="of the first gallery (%(default)s)")
    given = parser.parse_args()
    wanted, made, clips = given.kills, 0, given.first
    while made < wanted:
        with tempfile.TemporaryDirectory() as folder:
            for verb in ("build", "update"):
                made += _kill_everywhere(verb, clips, Path(folder) / verb, wanted - made)
        print(f"{made} kills, galleries of up to {clips + 1} clips: whole every time", flush=True)
        clips += 1
    return 0


def _kill_everywhere(verb: str, clips: int, folder: Path, most: int) -> int:
    """Kill one verb at each of its steps; how many kills that were."""
    from fake_embedder import open_fake
    from motions import walking

    from motionrt.retrieval import build_gallery

    source = folder / "clips"
    source.mkdir(parents=True)
    for number in range(clips):
        walking(24, speed=0.8 + 0.1 * number).save(source / f"{number}.npz")
    before = folder / "before"
    if verb == "update":
        build_gallery(source, open_fake, out=before)
        walking(24, speed=3.0).save(source / "new.npz")
    for step in range(most):
        target = folder / f"gallery-{step}"
        if verb == "update":
            shutil.copytree(before, target)
        if not killed_in_fork(step, verb, source, target):
            return step
        _check(verb, clips, target)
    return most


def _check(verb: str, clips: int, target: Path) -> None:
    from motionrt.errors import GalleryNotFoundError
    from motionrt.retrieval import Gallery

    try:
        gallery = Gallery.open(target)
    except GalleryNotFoundError:
        if verb == "update":
            raise
        return
    gallery.verify()
    if len(gallery) not in ({clips} if verb == "build" else {clips, clips + 1}):
        raise AssertionError(f"{target} has {len(gallery)} clips")


if __name__ == "__main__":
    sys.path[:0] = [str(HERE.parent / "helpers")]
    sys.exit(main())
