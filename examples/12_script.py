"""A scene, a start and steps from a YAML file: to the sofa, sit, get up, grab, walk out.

python examples/12_script.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    script = Path(__file__).with_name("living_room.yaml")
    performance = motionrt.Runtime().play(script)
    for segment in performance.segments:
        print(segment)
    performance.motion.save(folder / "living_room.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
