"""A process that builds or updates a gallery and is killed at its n-th step on the disk."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
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
