"""The canonical skeleton ``smpl24``: 24 joints, T-pose rest, metres, Y up, facing +Z, left is +X."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError

FloatArray = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A joint tree with a T-pose rest.

    Attributes:
        names: ``J`` joint names, parents before children.
        parents: ``J`` parent indices, ``-1`` for the root.
        offsets: ``(J, 3)`` float32, metres, from the parent in the rest pose.

    Raises:
        InvalidInputError: unequal lengths, or a joint that stands before its parent.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: FloatArray

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "offsets", np.array(self.offsets, dtype=np.float32))
        except (TypeError, ValueError) as error:
            raise InvalidInputError("offsets must be numbers (J, 3)") from error
        self.offsets.setflags(write=False)
        if not len(self.names) == len(self.parents) == len(self.offsets):
            raise InvalidInputError("a Skeleton needs as many parents and offsets as names")
        if not self.names or self.offsets.shape[1:] != (3,) or not np.isfinite(self.offsets).all():
            raise InvalidInputError("a Skeleton needs at least one joint, and finite offsets (J, 3)")
        if self.parents[0] != -1 or any(not 0 <= p < j for j, p in enumerate(self.parents) if j):
            raise InvalidInputError("a Skeleton has one root, first, and every parent stands before its children")

    def __len__(self) -> int:
        return len(self.names)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Skeleton):
            return NotImplemented
        same_tree = self.names == other.names and self.parents == other.parents
        return same_tree and np.array_equal(self.offsets, other.offsets)

    def __hash__(self) -> int:
        return hash((self.names, self.parents))

    def index(self, name: str) -> int:
        """Index of the joint called ``name``; raises InvalidInputError and lists the names otherwise."""
        try:
            return self.names.index(name)
        except ValueError:
            raise InvalidInputError(f"no joint '{name}'; joints are: {', '.join(self.names)}") from None

    @cached_property
    def rest_positions(self) -> FloatArray:
        """``(J, 3)`` joint positions of the rest pose, metres, root at the origin."""
        positions = self.offsets.copy()
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                positions[joint] += positions[parent]
        return positions

    @cached_property
    def mirrored_joints(self) -> tuple[int, ...]:
        """For every joint, the index of its left/right counterpart (itself on the midline)."""
        swap = {"left_": "right_", "right_": "left_"}
        partners = []
        for name in self.names:
            side = next((s for s in swap if name.startswith(s)), None)
            partners.append(self.index(swap[side] + name[len(side) :]) if side else self.index(name))
        return tuple(partners)


# name, parent, offset from the parent in metres: average adult proportions, about 1.72 m tall.
_SMPL24_TABLE: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("pelvis", None, (0.0, 0.0, 0.0)),
    ("left_hip", "pelvis", (0.085, -0.075, 0.0)),
    ("right_hip", "pelvis", (-0.085, -0.075, 0.0)),
    ("spine1", "pelvis", (0.0, 0.105, -0.015)),
    ("left_knee", "left_hip", (0.0, -0.405, 0.0)),
    ("right_knee", "right_hip", (0.0, -0.405, 0.0)),
    ("spine2", "spine1", (0.0, 0.125, 0.0)),
    ("left_ankle", "left_knee", (0.0, -0.410, -0.010)),
    ("right_ankle", "right_knee", (0.0, -0.410, -0.010)),
    ("spine3", "spine2", (0.0, 0.075, 0.010)),
    ("left_foot", "left_ankle", (0.0, -0.065, 0.135)),
    ("right_foot", "right_ankle", (0.0, -0.065, 0.135)),
    ("neck", "spine3", (0.0, 0.205, -0.010)),
    ("left_collar", "spine3", (0.065, 0.120, -0.005)),
    ("right_collar", "spine3", (-0.065, 0.120, -0.005)),
    ("head", "neck", (0.0, 0.095, 0.030)),
    ("left_shoulder", "left_collar", (0.115, 0.025, -0.005)),
    ("right_shoulder", "right_collar", (-0.115, 0.025, -0.005)),
    ("left_elbow", "left_shoulder", (0.270, 0.0, 0.0)),
    ("right_elbow", "right_shoulder", (-0.270, 0.0, 0.0)),
    ("left_wrist", "left_elbow", (0.250, 0.0, 0.0)),
    ("right_wrist", "right_elbow", (-0.250, 0.0, 0.0)),
    ("left_hand", "left_wrist", (0.085, 0.0, 0.0)),
    ("right_hand", "right_wrist", (-0.085, 0.0, 0.0)),
)


def _build_smpl24() -> Skeleton:
    names = tuple(name for name, _, _ in _SMPL24_TABLE)
    parents = tuple(-1 if parent is None else names.index(parent) for _, parent, _ in _SMPL24_TABLE)
    return Skeleton(names, parents, np.array([offset for _, _, offset in _SMPL24_TABLE], dtype=np.float32))


SMPL24 = _build_smpl24()
"""The canonical skeleton of motionrt (joint order of SMPL; the offsets are this project's own)."""

SMPL22_JOINTS = 22
"""The first 22 joints of ``smpl24`` (no hands) are the ones that ``sinc135`` and ``guo263`` describe."""
