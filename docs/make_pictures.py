"""Draw the README's filmstrips: for each query the first hit of a gallery.

    pip install ".[render]"
    python docs/make_pictures.py -o docs/images/retrieve.png "a person walks in a circle" [--gallery DIR]

Left limbs are blue, right limbs red; time runs from left to right.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from motionrt import Runtime, render
from motionrt.rendering import Take


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("queries", nargs="+")
    parser.add_argument("--gallery", help="a gallery (default: the starter gallery)")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    runtime = Runtime()
    takes = [_take(runtime, query, args.gallery) for query in args.queries]
    args.out.parent.mkdir(parents=True, exist_ok=True)
    render(takes, args.out, poses=12, camera=55, size=(1400, 0), times=False)


def _take(runtime: Runtime, query: str, gallery: str | None) -> Take:
    hit = runtime.retrieve(query, 1, gallery)[0]
    return Take(runtime.gallery(gallery).motion(hit), f"“{query}”:  {hit.id}  ({hit.score:.2f})")


if __name__ == "__main__":
    main()
