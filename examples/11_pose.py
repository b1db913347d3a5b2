"""A pose from a few keypoints, and the two seconds that lead into it.

python examples/11_pose.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    found = rt.pose({"right_hand": (-0.2, 1.4, 0.5), "left_foot": (0.1, 0, 0), "right_foot": (-0.1, 0, 0)})
    walk = rt.walk(to=(0, 3), stop=False).motion
    there = rt.transition(walk, found.motion, motionrt.Goal(0.0, 3.5))
    there.save(folder / "into_the_pose.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
