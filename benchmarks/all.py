"""The benchmark of a release: everything that `motionrt bench` measures, written to where it is published.

    python benchmarks/all.py --out docs/bench [--quick] [--install] [--figures docs/bench/bench.json]

Measures every benchmark with one and two threads beside torch, and texts beside torch + transformers (whichever of them
is installed), galleries up to a million clips, cold starts, memory, and the limits of the machine: some eight minutes
on two idle cores. Writes OUT/bench.json and OUT/bench.png, the README's table and the tables of docs/performance.md
(both between `<!-- bench -->` and `<!-- /bench -->`), and tells what would come into the manifest.
With --install also what fresh installations take (some minutes more); with --figures nothing is measured, and the
documents are written anew from those.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import install
from readme_table import MARKER, write

from motionrt.bench.markdown import between
from motionrt.bench.plot import save_plot
from motionrt.bench.report import Plan, quick, run_bench
from motionrt.bench.workload import SIZES
from motionrt.errors import MotionRTError

ROOT = Path(__file__).resolve().parent.parent
README, PERFORMANCE = ROOT / "README.md", ROOT / "docs" / "performance.md"
PLAN = Plan(threads=(1, 2), sizes=(*SIZES, 1_000_000), limits=True)
QUICK = quick(replace(PLAN, sizes=SIZES))


def main(given: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--documents", type=Path, nargs=2, default=(README, PERFORMANCE), metavar="FILE")
    parser.add_argument("--figures", type=Path, metavar="FILE", help="a bench.json, instead of measuring")
    parser.add_argument("--quick", action="store_true", help="a few calls only: shows that it runs, not how fast")
    parser.add_argument("--install", action="store_true", help="measure fresh installations, too")
    args = parser.parse_args(given)
    try:
        check_markers(args.documents)
        found = _figures(args)
        publish(found, args.out, args.documents)
    except MotionRTError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def check_markers(documents: Sequence[Path]) -> None:
    """Before minutes go by: InvalidInputError for a document that the tables have no place in."""
    for document in documents:
        between(document.read_text(encoding="utf-8"), MARKER, "")


def publish(found: Mapping[str, Any], out: Path, documents: Sequence[Path]) -> None:
    """Write figures, picture and documents: the README's first, then that with every figure."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "bench.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8", newline="\n")
    save_plot(found, out / "bench.png")
    for document, everything in zip(documents, (False, True), strict=True):
        write(document, found, everything=everything)
    print(f"wrote {out / 'bench.json'}, {out / 'bench.png'}, {documents[0]}, {documents[1]}", file=sys.stderr)


def _figures(args: argparse.Namespace) -> dict[str, Any]:
    if args.figures is not None:
        found: dict[str, Any] = json.loads(args.figures.read_text(encoding="utf-8"))
        return found
    rivals = [name for name in ("torch", "transformers") if find_spec(name)]
    plan = replace(QUICK if args.quick else PLAN, against=rivals)
    found = run_bench(plan, lambda text: print(text, file=sys.stderr))
    if args.install:
        with install.fresh_folder() as folder:
            found["installed"] = {name: asdict(each) for name, each in install.measured(folder).items()}
    return found


if __name__ == "__main__":
    sys.exit(main())
