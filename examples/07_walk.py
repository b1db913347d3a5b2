"""Walk to a place, and along a path, and see how well it went.

python examples/07_walk.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    walk = rt.walk(to=(2, 4), heading=0.0)
    print(walk.measures)
    walk.save(folder / "to_a_place.bvh")
    rt.walk(path=motionrt.Path([(0, 0), (0, 3), (3, 3)]), speed=1.0).save(folder / "round_a_corner.glb")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
