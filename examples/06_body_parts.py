"""Which parts of the body an action needs, by rules that run offline.

python examples/06_body_parts.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import motionrt


def main(folder: Path) -> None:
    rt = motionrt.Runtime()
    texts = ("kick with the right leg", "put headphones over the ears", "walk in a circle")
    rows = [f"{text}: {', '.join(sorted(rt.body_parts(text)))}" for text in texts]
    print("\n".join(rows))
    (folder / "body_parts.txt").write_text("\n".join(rows), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
