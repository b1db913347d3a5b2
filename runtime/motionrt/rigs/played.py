"""A probe motion as a rig plays it, by plain forward kinematics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.rigs.plain_kinematics import joint_transforms
from motionrt.rigs.retarget_out import to_rig
from motionrt.rigs.target import Rig


@dataclass(frozen=True, eq=False)
class Played:
    """A probe on the rig, Y up, human size: ``places (F, J, 3)`` metres, ``turns`` global and ``rotations`` local."""

    places: Array
    turns: Array
    rotations: Array
    roles: Mapping[str, int]
    sole: float

    def bone(self, upper: str, lower: str) -> Array:
        """Vectors ``(F, 3)`` from one role's joint to another's."""
        return np.asarray(self.places[:, self.roles[lower]] - self.places[:, self.roles[upper]])


def played_on(motion: Motion, rig: Rig, mapping: Mapping[str, str] | None, roles: Mapping[str, str]) -> Played:
    """``motion`` retargeted to ``rig``, with the roles ``smpl24`` joint name -> joint name."""
    out = to_rig(motion, rig, mapping=mapping)
    transforms = joint_transforms(out.clip)
    up = out.up.astype(np.float64) / np.linalg.norm(out.up)
    world = _upright(up)
    places = transforms[..., :3, 3] @ world.T / out.units_per_metre
    index = {role: out.clip.names.index(name) for role, name in roles.items()}
    sole = float(out.sole) / out.units_per_metre
    return Played(places, world @ transforms[..., :3, :3], out.clip.rotations.astype(np.float64), index, sole)


def _upright(up: Array) -> Array:
    """The shortest rotation that takes ``up`` to +Y, by its closed form."""
    axis, cosine = np.cross(up, [0.0, 1.0, 0.0]), float(up[1])
    if cosine < -1 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + cosine))
