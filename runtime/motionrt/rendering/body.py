"""The figure: which rounded cones stand for a body, where they are in a pose, and what colour each has."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24, FloatArray, Skeleton

SOLE = 0.036
"""Metres from the toe joint, which stands on y = 0, to the sole: the floor is drawn so much lower."""

Place = tuple[str, tuple[float, float, float]]
TONES = ("body", "left", "right", "head", "face")


class Cone(NamedTuple):
    """A rounded cone between two places that are fixed to joints; metres."""

    start: Place
    end: Place
    radii: tuple[float, float]
    tone: str


class Build(NamedTuple):
    """Cones of a skeleton as arrays: joints ``(N, 2)``, offsets ``(N, 2, 3)``, radii ``(N, 2)``, tones ``(N,)``."""

    joints: FloatArray
    offsets: FloatArray
    radii: FloatArray
    tones: tuple[str, ...]


_HERE = (0.0, 0.0, 0.0)
_TRUNK = (
    Cone(("left_hip", (-0.01, 0.03, 0.0)), ("right_hip", (0.01, 0.03, 0.0)), (0.098, 0.098), "body"),
    Cone(("pelvis", _HERE), ("spine2", (0.0, 0.0, 0.005)), (0.118, 0.112), "body"),
    Cone(("spine2", (0.035, 0.03, 0.0)), ("spine3", (0.062, 0.085, 0.0)), (0.095, 0.098), "body"),
    Cone(("spine2", (-0.035, 0.03, 0.0)), ("spine3", (-0.062, 0.085, 0.0)), (0.095, 0.098), "body"),
    Cone(("spine2", (0.0, 0.03, 0.02)), ("spine3", (0.0, 0.085, 0.015)), (0.095, 0.10), "body"),
    Cone(("neck", _HERE), ("head", (0.0, 0.01, 0.0)), (0.052, 0.05), "head"),
    Cone(("head", (0.0, 0.045, 0.022)), ("head", (0.0, 0.105, -0.002)), (0.077, 0.089), "head"),
    Cone(("head", (0.036, 0.090, 0.066)), ("head", (-0.036, 0.090, 0.066)), (0.027, 0.027), "face"),
)


def _limbs(side: str, out: float) -> tuple[Cone, ...]:
    """An arm and a leg; ``out`` is +1 for the left."""
    joint = {name: f"{side}_{name}" for name in ("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "foot")}
    heel = (joint["ankle"], (0.0, -0.062, -0.035))
    return (
        Cone(("neck", (0.0, -0.045, 0.0)), (joint["shoulder"], (-0.02 * out, 0.0, 0.0)), (0.062, 0.062), "body"),
        Cone((joint["shoulder"], _HERE), (joint["elbow"], _HERE), (0.058, 0.044), side),
        Cone((joint["elbow"], _HERE), (joint["wrist"], _HERE), (0.045, 0.032), side),
        Cone((joint["wrist"], _HERE), (joint["hand"], (0.045 * out, 0.0, 0.0)), (0.036, 0.030), side),
        Cone((joint["hip"], _HERE), (joint["knee"], _HERE), (0.088, 0.060), side),
        Cone((joint["knee"], _HERE), (joint["ankle"], _HERE), (0.062, 0.040), side),
        Cone((joint["ankle"], _HERE), heel, (0.042, SOLE), side),
        Cone(heel, (joint["foot"], _HERE), (SOLE, SOLE), side),
        Cone((joint["foot"], _HERE), (joint["foot"], (0.0, 0.0, 0.06)), (SOLE, 0.028), side),
    )


_PERSON = (*_TRUNK, *_limbs("left", 1.0), *_limbs("right", -1.0))


@cache
def build_of(skeleton: Skeleton) -> Build:
    """The cones of a skeleton: a person for ``smpl24``, a cone for each bone of any other."""
    cones = _PERSON if set(SMPL24.names) <= set(skeleton.names) else _bones(skeleton)
    return Build(
        np.array([[skeleton.index(place[0]) for place in (cone.start, cone.end)] for cone in cones]),
        np.array([[cone.start[1], cone.end[1]] for cone in cones], np.float32),
        np.array([cone.radii for cone in cones], np.float32),
        tuple(cone.tone for cone in cones),
    )


def _bones(skeleton: Skeleton) -> tuple[Cone, ...]:
    thick = 0.03 * max(float(np.ptp(skeleton.rest_positions, axis=0).max()), 1e-3) / 1.7
    pairs = [(name, skeleton.names[parent]) for name, parent in zip(skeleton.names, skeleton.parents, strict=True)]
    return tuple(
        Cone((parent, _HERE), (name, _HERE), (thick, thick), _tone(name))
        for (name, parent), above in zip(pairs, skeleton.parents, strict=True)
        if above >= 0 or len(pairs) == 1
    )


def _tone(name: str) -> str:
    lower = name.lower()
    return next((side for side in ("left", "right") if lower.startswith(side)), "body")


def cone_ends(motion: Motion, frame: int) -> FloatArray:
    """``(N, 2, 3)`` metres: the ends of the cones in a frame."""
    build = build_of(motion.skeleton)
    turned = np.einsum("npij,npj->npi", motion.global_rotations()[frame][build.joints], build.offsets)
    return np.asarray(motion.positions()[frame][build.joints] + turned, np.float32)
