"""Say in words what a motion shows, and find where in a long motion something happens.

python examples/03_describe.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    motion = rt.generate("a person waves with the right hand", seconds=4, seed=1)
    for description in rt.describe(motion, k=3):
        print(f"{description.score:.2f}  {description.text}")
    for moment in rt.moments("waving", motion, k=2).best:
        print(f"{moment.score:.2f}  {moment.start_s:.1f} to {moment.end_s:.1f} s")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
