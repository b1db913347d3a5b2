"""Index a folder of motion files once, search it, and bring the index up to date.

python examples/02_own_library.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    library = folder / "library"
    library.mkdir(exist_ok=True)
    for number, text in enumerate(("a person waves with the right hand", "a person jumps up")):
        rt.generate(text, seconds=2, seed=number).save(library / f"take_{number}.bvh")
    print(rt.build_gallery(library))
    print([hit.id for hit in rt.retrieve("waving", k=2, gallery=library)])

    rt.walk(to=(0, 3)).motion.save(library / "walk.bvh")
    print(rt.update_gallery(library).added, "is new")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
