"""Walk round obstacles: ground from polygons, a planned path, a walk along it.

python examples/08_scene.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    scene = motionrt.Scene.from_polygons(
        [[(-1, -1), (5, -1), (5, 7), (-1, 7)]],
        obstacles=[[(1, 2), (5, 2), (5, 3), (1, 3)]],
    )
    rt = motionrt.Runtime()
    path = rt.plan(scene, (3, 0), (3, 5))
    print(f"{path.length:.1f} m round the wall")
    rt.walk(to=(3, 5), scene=scene, start=(3, 0)).save(folder / "round_the_wall.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
