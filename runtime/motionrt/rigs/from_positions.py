"""A :class:`Motion` from joint positions alone: what text-to-motion models and pose trackers give.

Limbs point exactly where the positions have them. How a bone is turned about its own length is read off the joint below
it: knees and elbows bend about their hinges, pelvis and chest are turned as the lines of hips and shoulders are.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.kinematics import global_to_local
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import (
    Array,
    matrix_to_quaternion,
    normalise,
    quaternion_to_matrix,
    rotation_between,
    slerp,
)
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24
from motionrt.rigs.alignment import SIDES, rest_direction
from motionrt.rigs.calibration import matched
from motionrt.rigs.placement import place_root
from motionrt.rigs.pose import RigPose
from motionrt.rigs.roles import RigRoles

_X, _Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
_STRAIGHT = 0.05
"""Weight of the neutral hinge against the sine of the bend: it decides only where a limb is straight."""


def motion_from_positions(positions: Array, fps: float) -> Motion:
    """A motion whose bones point as those between the positions.

    Args:
        positions: ``(F, 22 or 24, 3)`` joints in the order of ``smpl24``, Y up, any unit and body size.
        fps: frames per second.

    Raises:
        InvalidInputError: another shape, or numbers that are not finite.
    """
    places = np.asarray(positions, dtype=np.float64)
    if places.ndim != 3 or places.shape[1] not in (SMPL22_JOINTS, len(SMPL24)) or places.shape[2] != 3:
        raise InvalidInputError(f"positions must have the shape (frames, 22 or 24, 3), not {places.shape}")
    if not len(places) or not np.isfinite(places).all():
        raise InvalidInputError("positions must be at least one frame of finite numbers")
    turned = _Turner(places[:, :SMPL22_JOINTS]).all()
    roles = RigRoles({SMPL24.names[j]: j for j in range(SMPL22_JOINTS)}, (3, 6, 9), (12, 15), sided=True)
    root = place_root(turned, RigPose(places, np.zeros((*places.shape, 3)), roles), fps)
    return Motion(global_to_local(turned, SMPL24.parents).astype(np.float32), root.astype(np.float32), fps)


@dataclass(frozen=True, eq=False)
class _Turner:
    """Global rotations of the 24 joints from positions ``(F, 22, 3)``."""

    places: Array

    def all(self) -> Array:
        out = np.tile(np.eye(3), (len(self.places), len(SMPL24), 1, 1))
        self._trunk(out)
        for side in SIDES:
            self._limb(out, side, ("hip", "knee", "ankle"), 0, _X)
            self._foot(out, side)
            collar = SMPL24.index(f"{side}_collar")
            out[:, collar] = self._swung(out[:, SMPL24.index("spine3")], f"{side}_collar", f"{side}_shoulder")
            self._limb(out, side, ("shoulder", "elbow", "wrist"), collar, -_Y if side == "left" else _Y)
            for part in ("wrist", "hand"):
                out[:, SMPL24.index(f"{side}_{part}")] = out[:, SMPL24.index(f"{side}_elbow")]
        return out

    def _bone(self, upper: str, lower: str) -> Array:
        return np.asarray(self.places[:, SMPL24.index(lower)] - self.places[:, SMPL24.index(upper)])

    def _swung(self, base: Array, upper: str, lower: str) -> Array:
        """``base`` turned by as little as makes its bone point as the positions have it."""
        return np.asarray(rotation_between(base @ rest_direction(upper, lower), self._bone(upper, lower)) @ base)

    def _trunk(self, out: Array) -> None:
        names = ("spine1", "spine2", "spine3")
        rise = normalise(0.5 * (rest_direction("left_hip", "spine1") + rest_direction("right_hip", "spine1")))
        above = self._bone("left_hip", "spine1") + self._bone("right_hip", "spine1")
        out[:, 0] = matched((self._bone("right_hip", "left_hip"), above), (_X, rise))
        line = self._bone("right_shoulder", "left_shoulder")
        chest = matched((self._bone("spine3", "neck"), line), (rest_direction("spine3", "neck"), _X))
        start, end = matrix_to_quaternion(out[:, 0]), matrix_to_quaternion(chest)
        for k, (name, above_it) in enumerate(pairwise((*names, "neck")), start=1):
            shared = np.asarray(quaternion_to_matrix(slerp(start, end, np.full(len(start), k / 3))))
            out[:, SMPL24.index(name)] = self._swung(shared, name, above_it)
        out[:, SMPL24.index("neck")] = self._swung(chest, "neck", "head")
        out[:, SMPL24.index("head")] = out[:, SMPL24.index("neck")]

    def _limb(self, out: Array, side: str, line: tuple[str, str, str], base: int, axis: Array) -> None:
        top, middle, end = (f"{side}_{part}" for part in line)
        upper, lower = normalise(self._bone(top, middle)), normalise(self._bone(middle, end))
        swung = self._swung(out[:, base], top, middle)
        hinge = np.cross(upper, lower) + _STRAIGHT * (swung @ axis)
        for role, bone, below in ((top, upper, middle), (middle, lower, end)):
            out[:, SMPL24.index(role)] = matched((bone, hinge), (rest_direction(role, below), axis))

    def _foot(self, out: Array, side: str) -> None:
        ankle, toe = f"{side}_ankle", f"{side}_foot"
        across = out[:, SMPL24.index(f"{side}_knee"), :, 0]
        turned = matched((self._bone(ankle, toe), across), (rest_direction(ankle, toe), _X))
        out[:, SMPL24.index(ankle)] = out[:, SMPL24.index(toe)] = turned
