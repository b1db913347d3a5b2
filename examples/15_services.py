"""Only what a program needs: walking without search, and onnxruntime's provider of your choice.

python examples/15_services.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

from motionrt.services import Locomotion


def main(folder: Path) -> None:
    walker = Locomotion(threads=1, providers=["CPUExecutionProvider"])  # or CUDA, DirectML, OpenVINO, then the CPU
    walker.walk(to=(1, 2)).save(folder / "walk.bvh")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
