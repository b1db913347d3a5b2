"""Units of files: by name, or the usual one that makes the legs of a rig those of a person."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.rotations import rotation_between
from motionrt.rigs.clip import RigClip
from motionrt.rigs.target import RigMotion
from motionrt.untrusted.words import shown

UNITS = {"m": 1.0, "cm": 100.0, "mm": 1000.0, "in": 1 / 0.0254}
"""Names of units and how many of them are a metre."""

_METRIC, _OTHERS = (1.0, 0.01, 0.001), (0.1, 0.0254, 0.3048, 2.54 / 45, 0.056444)
"""Metres per unit: metres, centimetres, millimetres; decimetres, inches, feet, and CMU's 2.54/45 m."""

_RARER = 0.5
"""How much nearer, as a logarithm, one of the others has to be: a child in cm is as tall as an adult in 1/50 m."""


def units_per_metre(units: str) -> float:
    """How many of the unit of that name are a metre; InvalidInputError lists the names."""
    if not isinstance(units, str) or units not in UNITS:
        raise InvalidInputError(f"units must be one of {', '.join(UNITS)}, not {shown(units)}")
    return UNITS[units]


def metres_per_unit(units_per_metre: float) -> float:
    """The usual unit nearest to that of a rig with so many units per metre of ``smpl24``; metric ones first."""
    off = {unit: abs(float(np.log(unit * units_per_metre))) for unit in _METRIC}
    off |= {unit: abs(float(np.log(unit * units_per_metre))) + _RARER for unit in _OTHERS}
    return min(off, key=off.__getitem__)


def to_metres(motion: RigMotion) -> RigClip:
    """The motion's clip in metres and Y up."""
    clip, scale = motion.clip, motion.clip.metres_per_unit or metres_per_unit(motion.units_per_metre)
    turn = rotation_between(motion.up, np.array([0.0, 1.0, 0.0]))
    root = [joint for joint, parent in enumerate(clip.parents) if parent < 0]
    offsets, translations = clip.offsets * scale, clip.translations * scale
    rotations, rest = clip.rotations.copy(), clip.rest_rotations().copy()
    for joint in root:
        offsets[joint], translations[:, joint] = turn @ offsets[joint], translations[:, joint] @ turn.T
        rest[joint], rotations[:, joint] = turn @ rest[joint], turn @ rotations[:, joint]
    return replace(
        clip,
        offsets=offsets.astype(np.float32),
        translations=translations.astype(np.float32),
        rotations=rotations.astype(np.float32),
        rest=rest.astype(np.float32),
        up="y",
        metres_per_unit=1.0,
    )
