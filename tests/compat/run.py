"""Run the runtime's tests on the lowest and on the newest dependencies, from the built wheel, in fresh environments.

Needs Python 3.11; the Pythons that are tested may be older.

    python tests/compat/run.py                                     # both, this Python
    python tests/compat/run.py --python python3.10 --python python3.13 --only newest
    python tests/compat/run.py --keep /tmp/compat -- -k "not shipped" -x   # what follows -- goes to pytest

The versions come from pyproject.toml: the lowest is what stands behind ``>=``. Extras are tested with the rest; give
``--extras ''`` for the base install alone.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import tomllib

ROOT = Path(__file__).parents[2]
TEST_TOOLS = ("pytest", "hypothesis")
KINDS = ("lowest", "newest")
_REQUIREMENT = re.compile(r"^\s*([A-Za-z0-9._-]+)\s*>=\s*([0-9][0-9A-Za-z.]*)(?:\s*,\s*!=\s*[0-9][0-9A-Za-z.]*)*\s*$")


def main(argv: Sequence[str] | None = None) -> int:
    arguments, for_pytest = _arguments(list(sys.argv[1:] if argv is None else argv))
    results = []
    with ExitStack() as stack:
        folder = arguments.keep or Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="motionrt-compat-")))
        folder.mkdir(parents=True, exist_ok=True)
        wheel = build_wheel(folder)
        for python in arguments.python or [sys.executable]:
            for kind in arguments.only or KINDS:
                home = folder / f"{Path(python).name}-{kind}"
                results.append((python, kind, _one(python, home, wheel, kind, arguments, for_pytest)))
    for python, kind, outcome in results:
        print(f"{outcome:>20}  {kind}  {python}")
    return 0 if all(outcome == "passed" for _, _, outcome in results) else 1


def _arguments(argv: list[str]) -> tuple[argparse.Namespace, list[str]]:
    split = argv.index("--") if "--" in argv else len(argv)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", action="append", metavar="EXE", help="an interpreter; may be repeated")
    parser.add_argument("--only", action="append", choices=KINDS)
    parser.add_argument("--extras", default="scene,render", help="extras to install and test (default: scene,render)")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="make the environments there, and leave them")
    return parser.parse_args(argv[:split]), argv[split + 1 :]


def _one(
    python: str, home: Path, wheel: Path, kind: str, arguments: argparse.Namespace, for_pytest: Sequence[str]
) -> str:
    """What became of one environment, in words."""
    extras = [extra for extra in arguments.extras.split(",") if extra]
    asked = requirements(ROOT / "pyproject.toml", extras)
    pins = [f"{name}=={low}" for name, low in asked.items()] if kind == "lowest" else list(asked)
    print(f"== {kind}, {python}: {' '.join(pins)}", flush=True)
    _run([python, "-m", "venv", "--clear", str(home)])
    inner = str(home / ("Scripts" if os.name == "nt" else "bin") / "python")
    try:
        _run([inner, "-m", "pip", "install", "-q", "--disable-pip-version-check", *pins, *TEST_TOOLS, str(wheel)])
    except subprocess.CalledProcessError:
        return "cannot be installed"
    _run([inner, "-m", "pip", "list", "--disable-pip-version-check"])
    started = time.monotonic()
    code = subprocess.run(
        [inner, "-m", "pytest", "tests/runtime", "-q", "-p", "no:cacheprovider", *for_pytest], cwd=ROOT, check=False
    ).returncode
    print(f"== {kind}: exit code {code} after {time.monotonic() - started:.0f} s", flush=True)
    return "passed" if code == 0 else "failed"


def requirements(pyproject: Path, extras: Sequence[str] = ()) -> dict[str, str]:
    """The dependencies of a pyproject.toml with the lowest version of each: ``name>=version``, and ``!=`` behind it."""
    project = tomllib.loads(pyproject.read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]
    listed = [*project["dependencies"], *(line for extra in extras for line in optional[extra])]
    found = {}
    for line in listed:
        match = _REQUIREMENT.match(line)
        if match is None:
            raise SystemExit(f"{pyproject}: '{line}' has no lowest version: write name>=version")
        found[match[1].lower()] = match[2]
    return found


def build_wheel(folder: Path) -> Path:
    """The project's wheel, built into a folder."""
    _run([sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT)])
    return max(folder.glob("motionrt-*.whl"), key=lambda path: path.stat().st_mtime)


def _run(command: Sequence[str]) -> None:
    subprocess.run(command, check=True, cwd=ROOT)


if __name__ == "__main__":
    sys.exit(main())
