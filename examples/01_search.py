"""Find motions by text in the starter library, and save the best one.

python examples/01_search.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    hits = rt.retrieve("a person walks and turns left", k=5)
    for hit in hits:
        print(f"{hit.rank}  {hit.score:.2f}  {hit.start_s:.1f} to {hit.end_s:.1f} s  {hit.id}")
    rt.gallery().motion(hits[0]).save(folder / "best.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
