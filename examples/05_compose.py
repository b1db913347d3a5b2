"""Play several motions in one body: the legs of a walk and the arm of a wave.

python examples/05_compose.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    walk = rt.walk(to=(0, 4)).motion
    wave = rt.generate("a person waves with the right hand", seconds=4, seed=1)
    rt.compose([walk, wave], [None, "right arm"]).save(folder / "walk_and_wave.bvh")
    rt.compose(["walk forward", "raise the left arm"], seconds=3, seed=2).save(folder / "of_two_texts.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
