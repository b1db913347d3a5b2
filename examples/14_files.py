"""Read any file, look at the numbers, and write another format.

python examples/14_files.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    motionrt.Runtime().walk(to=(0, 3)).motion.save(folder / "walk.bvh", units="m", t_pose=True)
    motion = motionrt.load_motion(folder / "walk.bvh")
    print(motion, motion.positions().shape, "joint positions in metres, Y up")
    motion.resample(20).grounded().canonical().save(folder / "walk.npz")  # as AMASS has it
    print(motionrt.load_rig(folder / "walk.bvh").names[:3], "as the file has them")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
