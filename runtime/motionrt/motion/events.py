"""What a game wants to know of a clip besides its frames: when the feet stand, and whether it can be looped."""

from __future__ import annotations

from typing import Any

import numpy as np

from motionrt.motion.feet.contacts import foot_contacts, stretches
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24
from motionrt.motion.transforms import canonical, floor_height

POSE_GAP, SPEED_GAP = 0.02, 0.3
"""A clip loops where its first and last pose are no farther apart, metres, and no speed differs by more, m/s."""


def events(motion: Motion) -> dict[str, Any]:
    """Plain values for JSON: ``contacts``, a list of ``foot``, ``from`` and ``to``, and ``loop``, ``from`` and ``to``
    or None; times in seconds. Both are read off the joints of ``smpl24``: other skeletons have none.
    """
    if motion.skeleton != SMPL24:
        return {"contacts": [], "loop": None}
    return {"contacts": _contacts(motion), "loop": _loop(motion)}


def _contacts(motion: Motion) -> list[dict[str, Any]]:
    found = foot_contacts(motion, floor_height(motion))
    rows = [
        {"foot": foot, "from": round(start / motion.fps, 4), "to": round((stop - 1) / motion.fps, 4)}
        for number, foot in enumerate(("left", "right"))
        for start, stop in stretches(found[:, number])
    ]
    return sorted(rows, key=lambda row: (row["from"], row["foot"]))


def _loop(motion: Motion) -> dict[str, float] | None:
    """From the first frame to the last where the one can follow the other."""
    if motion.frames < 4:
        return None
    ends = [canonical(motion[:2]).positions(), canonical(motion[-2:]).positions()]
    first, last = ends[0][0], canonical(motion[-1:]).positions()[0]
    speeds = [(end[1] - end[0]) * motion.fps for end in ends]
    near = np.linalg.norm(first - last, axis=1).max() <= POSE_GAP
    alike = np.linalg.norm(speeds[0] - speeds[1], axis=1).max() <= SPEED_GAP
    return {"from": 0.0, "to": round((motion.frames - 1) / motion.fps, 4)} if near and alike else None
