"""The six body parts of action labels, and the joints of each (SINC 3.1)."""

from __future__ import annotations

from collections.abc import Iterable

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import SMPL24
from motionrt.untrusted.arguments import iterable
from motionrt.untrusted.words import shown

PARTS = ("left arm", "right arm", "left leg", "right leg", "torso", "global")
"""The six body parts of SINC; ``global`` is the orientation and translation of the whole body."""

ARMS, LEGS, (TORSO, GLOBAL) = PARTS[:2], PARTS[2:4], PARTS[4:]


def _joints(*names: str) -> tuple[int, ...]:
    return tuple(SMPL24.index(name) for name in names)


PART_JOINTS: dict[str, tuple[int, ...]] = {
    **{
        f"{side} arm": _joints(*(f"{side}_{joint}" for joint in ("collar", "shoulder", "elbow", "wrist", "hand")))
        for side in ("left", "right")
    },
    **{
        f"{side} leg": _joints(*(f"{side}_{joint}" for joint in ("hip", "knee", "ankle", "foot")))
        for side in ("left", "right")
    },
    "torso": _joints("spine1", "spine2", "spine3", "neck", "head"),
    "global": _joints("pelvis"),  # its rotation turns the whole body; the translation goes with it
}


def checked_parts(parts: Iterable[str]) -> frozenset[str]:
    """``parts`` as a set of names of :data:`PARTS`; "left_arm" and "Left Arm" are understood.

    Raises:
        InvalidInputError: a name that is none of the six, or no names at all; the message lists them.
    """
    if isinstance(parts, str):
        parts = [parts]
    if not iterable(parts):
        raise InvalidInputError(f"body parts must be a list of names, not {shown(parts)}; they are: {', '.join(PARTS)}")
    found = {str(part).strip().lower().replace("_", " ") for part in parts}
    unknown = sorted(found - set(PARTS))
    if unknown:
        raise InvalidInputError(f"unknown body part {', '.join(map(repr, unknown))}; the parts are: {', '.join(PARTS)}")
    return frozenset(found)
