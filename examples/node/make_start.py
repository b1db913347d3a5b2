"""Write start.json: the skeleton ``smpl24`` and a second of a steady walk, for programs without Python to begin with.

Run it as ``python examples/node/make_start.py``.
"""

from __future__ import annotations

import json
from pathlib import Path

from motionrt import SMPL24
from motionrt.locomotion.crowd import history_of
from motionrt.locomotion.starting_poses import stride


def start() -> dict[str, object]:
    """``{"skeleton": {names, parents, offsets}, "stride": 30 frames of 219 numbers}``."""
    skeleton = {
        "names": SMPL24.names,
        "parents": SMPL24.parents,
        "offsets": [[round(float(x), 6) for x in offset] for offset in SMPL24.offsets],
    }
    return {"skeleton": skeleton, "stride": [[round(float(x), 6) for x in frame] for frame in history_of(stride())]}


if __name__ == "__main__":
    path = Path(__file__).with_name("start.json")
    path.write_text(json.dumps(start(), separators=(",", ":")) + "\n", encoding="utf-8")
    print(path)
