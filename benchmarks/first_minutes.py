"""The first minutes of a newcomer: a clean clone, a clean environment, the README's commands, and the seconds of each.

    python benchmarks/first_minutes.py [--repository .] [--keep DIR] [--write docs/first_minutes.md]

Clones the repository, makes an environment, runs every command of "One minute" in the README as it stands there, and
then opens the studio in headless Chromium (where there is one). Needs the network for pip. With --write the table goes
between the marks `<!-- minutes -->` and `<!-- /minutes -->` of a document.
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
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
MARK = "minutes"
BLOCK = re.compile(r"^## One minute\n.*?^```bash\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Step(NamedTuple):
    """What was done, and the seconds that it took."""

    what: str
    seconds: float


def main(given: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repository", default=str(ROOT), help="what is cloned (default: this one)")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="leave what is made there; otherwise it is removed")
    parser.add_argument("--write", type=Path, metavar="FILE", help="a document to put the table into")
    arguments = parser.parse_args(given)
    with tempfile.TemporaryDirectory() as folder:
        steps = walk_through(arguments.repository, arguments.keep or Path(folder))
    text = table(steps)
    print(text)
    if arguments.write is not None:
        before = arguments.write.read_text(encoding="utf-8")
        marked = re.compile(f"(<!-- {MARK} -->\n).*?(<!-- /{MARK} -->)", re.DOTALL)
        arguments.write.write_text(marked.sub(lambda found: f"{found[1]}{text}\n{found[2]}", before), encoding="utf-8")
    return 0


def walk_through(repository: str, folder: Path) -> list[Step]:
    """Every step, in order.

    Raises:
        CalledProcessError: a command of the README does not work.
    """
    clone, environment = folder / "motionrt", folder / "venv"
    bin_ = environment / ("Scripts" if os.name == "nt" else "bin")
    settings = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "VIRTUAL_ENV"}}
    settings["PATH"] = f"{bin_}{os.pathsep}{os.environ['PATH']}"
    steps = [timed("git clone", ["git", "clone", "-q", "--depth", "1", f"file://{repository}", str(clone)], folder, {})]
    steps.append(timed("python -m venv", [sys.executable, "-m", "venv", str(environment)], folder, settings))
    readme = (clone / "README.md").read_text(encoding="utf-8")
    found = BLOCK.search(readme)
    if found is None:
        sys.exit("the README has no block under 'One minute'")
    steps += [timed(f"`{line}`", ["bash", "-c", line], clone, settings) for line in found[1].splitlines()]
    return [*steps, *studio(clone, settings)]


def timed(what: str, command: list[str], folder: Path, settings: dict[str, str]) -> Step:
    """Run a command to its end."""
    print(f"... {what}", file=sys.stderr, flush=True)
    began = time.perf_counter()
    subprocess.run(command, cwd=folder, env=settings or None, check=True, stdout=subprocess.DEVNULL)
    return Step(what, time.perf_counter() - began)


def studio(clone: Path, settings: dict[str, str]) -> list[Step]:
    """From the command to its address, to the page with its panels, and to a first hit that plays."""
    sys.path.insert(0, str(ROOT / "tests" / "helpers"))
    from chromium import browser, find_chromium

    if find_chromium() is None:
        print("no Chromium: the studio is left out", file=sys.stderr)
        return []
    with tempfile.TemporaryDirectory() as folder, browser(Path(folder)) as opened:
        began = time.perf_counter()
        process = subprocess.Popen(
            ["motionrt", "studio", "--port", "0", "--no-browser"],
            cwd=clone, env=settings, executable=str(Path(settings["PATH"].split(os.pathsep)[0]) / "motionrt"),
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            assert process.stderr is not None
            address = process.stderr.readline().split()[0]
            steps = [Step("`motionrt studio`, until its address is told", time.perf_counter() - began)]
            page = opened.open(address, 1024, 640, 0.5)
            page.wait_text("Find", 60)
            steps.append(Step("... until its page stands in the browser", time.perf_counter() - began))
            asked = time.perf_counter()
            page.click("Find")
            page.wait_text("hits in", 60)
            steps.append(Step("in the studio: *Find*, until hits are there", time.perf_counter() - asked))
            asked = time.perf_counter()
            page.tab("Make")
            page.click("Generate")
            page.wait_text("generated in", 60)
            steps.append(Step("in the studio: *Make*, *Generate*, until it plays", time.perf_counter() - asked))
        finally:
            process.terminate()
            process.wait(20)
    return steps


def table(steps: Sequence[Step]) -> str:
    """Markdown."""
    rows = [f"| {step.what} | {step.seconds:.1f} |" for step in steps]
    return "\n".join(["| step | seconds |", "|---|---:|", *rows])


if __name__ == "__main__":
    sys.exit(main())
