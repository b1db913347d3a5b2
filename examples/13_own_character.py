"""A motion on a character of your own: its hierarchy, names and units stay.

python examples/13_own_character.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    hero = folder / "hero.glb"  # stands for your file: any humanoid GLB or BVH
    rt.generate("stand", seconds=1, seed=1).save(hero)

    target = motionrt.load_target(hero)  # read once, for many motions
    walk = rt.walk(to=(0, 3)).motion.retarget_to(target)
    print(walk)
    walk.save(folder / "hero_walks.glb")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
