"""Which of two motions moves which joint: steps 2 to 5 of SINC 3.1, from the body parts of their two labels."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import LEGS, PART_JOINTS, checked_parts
from motionrt.motion.features import sinc135
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24

IntArray = npt.NDArray[np.intp]

SUPPORT = frozenset({*LEGS, "global"})  # they come from one motion, together with the translation, or the feet slide


@dataclass(frozen=True, eq=False)
class Combination:
    """Where every joint of a combined motion comes from: 0 is the first motion given, 1 the second.

    Attributes:
        joints: ``(24,)`` 0 or 1 for each joint of ``smpl24``.
        translation: 0 or 1, the same as that of the pelvis (step 5).
        b: 0 or 1, which one is the paper's motion B, the one with fewer parts.
    """

    joints: IntArray
    translation: int
    b: int

    @property
    def features(self) -> IntArray:
        """``(135,)`` 0 or 1 for each column of ``sinc135``."""
        rotations = np.repeat(self.joints[:SMPL22_JOINTS], 6)
        return np.concatenate([rotations, np.full(sinc135.WIDTH - len(rotations), self.translation)])

    def apply(self, first: tuple[Array, Array], second: tuple[Array, Array]) -> tuple[Array, Array]:
        """Combine two of (rotations ``(F, 24, 3, 3)``, root ``(F, 3)``), trimmed to the shorter one (step 1)."""
        frames = min(len(first[1]), len(second[1]))
        mask = (self.joints == 1)[:, None, None]
        rotations = np.where(mask, second[0][:frames], first[0][:frames])
        return rotations, np.array((first, second)[self.translation][1][:frames])

    def apply_features(self, first: Array, second: Array) -> Array:
        """Combine two raw ``sinc135`` ``(..., F, 135)``, trimmed to the shorter one (step 1)."""
        if first.shape[-1] != sinc135.WIDTH or second.shape[-1] != sinc135.WIDTH:
            raise InvalidInputError(f"need sinc135 features (F, 135), not {first.shape} and {second.shape}")
        frames = min(first.shape[-2], second.shape[-2])
        return np.where(self.features == 1, second[..., :frames, :], first[..., :frames, :])


def combination(parts_a: Iterable[str], parts_b: Iterable[str], *, override: bool = False) -> Combination:
    """Combine the first motion, moved on purpose in ``parts_a``, with the second, in ``parts_b`` (SINC 3.1).

    The paper's steps: (1) both are trimmed to the shorter; (2) B is the motion with fewer parts, the second one in a
    tie; (3) if B has a leg or "global", both legs, the global orientation and the translation come from B; (4) B's own
    parts come from B and the rest from A; (5) the translation goes with the global orientation.

    Args:
        parts_a: body parts of the first motion, names of :data:`~motionrt.motion.body_parts.PARTS`.
        parts_b: those of the second one.
        override: combine parts that clash too, as at test time: where both want a part, B gets it.

    Raises:
        InvalidInputError: an unknown part; or parts that clash, and no ``override``.
    """
    given = checked_parts(parts_a), checked_parts(parts_b)
    common = clash(*given)
    if common and not override:
        raise InvalidInputError(
            f"both motions need {_listed(common)}; override=True gives them to the one of fewer parts"
        )
    b = 0 if len(given[0]) < len(given[1]) else 1
    taken = with_support(given[b])
    joints = np.full(len(SMPL24), 1 - b, dtype=np.intp)
    joints[[joint for part in taken for joint in PART_JOINTS[part]]] = b
    joints.setflags(write=False)
    return Combination(joints, translation=int(joints[0]), b=b)


def compatible(parts_a: Iterable[str], parts_b: Iterable[str]) -> bool:
    """Whether two labels may be combined as synthetic data: both still show all of their parts afterwards.

    That is: each has a part, none is common to both, and not both need the support, which is both legs, the global
    orientation and the translation together.
    """
    a, b = checked_parts(parts_a), checked_parts(parts_b)
    return bool(a and b) and not clash(a, b)


def with_support(parts: frozenset[str]) -> frozenset[str]:
    """``parts`` with both legs and "global" if it has one of them (step 3)."""
    return parts | SUPPORT if parts & SUPPORT else parts


def clash(a: frozenset[str], b: frozenset[str]) -> frozenset[str]:
    """The parts that both want."""
    return with_support(a) & with_support(b)


def _listed(parts: frozenset[str]) -> str:
    return ", ".join(sorted(parts))
