"""A filmstrip of a motion (extra: render).

python examples/16_picture.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    motion = motionrt.Runtime().generate("a person waves with the right hand", seconds=3, seed=1)
    motionrt.render(motion, folder / "wave.png", poses=6)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
