"""Make motion of words: the same seed gives the same motion, several samples differ.

python examples/04_generate.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    for number, motion in enumerate(rt.generate("kick with the left foot", seconds=3, n=2, seed=7)):
        print(motion)
        motion.save(folder / f"kick_{number}.glb")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
