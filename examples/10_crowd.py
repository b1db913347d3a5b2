"""Many characters in one call of the model per frame.

python examples/10_crowd.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import motionrt


def main(folder: Path) -> None:
    crowd = motionrt.Runtime().crowd(8)
    goals = np.array([[x, 20.0, 0.0] for x in np.linspace(-4, 4, 8)], dtype=np.float32)  # x, z, heading
    for _ in range(60):
        frames = crowd.step(goals)
    print(frames.shape, "of the last frame")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
