"""A shell that finds the motionrt under test, as users have it on their path."""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path


def shell_environment(folder: Path) -> dict[str, str]:
    """Variables of a shell with a command ``motionrt``, which is put into ``folder/.bin``; its browser is nobody."""
    scripts = folder / ".bin"
    scripts.mkdir(exist_ok=True)
    command = scripts / "motionrt"
    command.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m motionrt "$@"\n')
    command.chmod(0o755)
    modules = os.pathsep.join(str(Path(path).resolve()) for path in sys.path if path)
    path = f"{scripts}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "PYTHONPATH": modules, "BROWSER": "true", "PYTHON": sys.executable}
